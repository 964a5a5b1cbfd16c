#include "io/units.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "io/text_file.hpp"

namespace voussoir::io {

namespace {

constexpr double degree = std::numbers::pi / 180;

constexpr std::array table{
    Unit{"", Dimension::none, 1},
    Unit{"%", Dimension::none, 1e-2},
    Unit{"m", Dimension::length, 1},
    Unit{"cm", Dimension::length, 1e-2},
    Unit{"mm", Dimension::length, 1e-3},
    Unit{"km", Dimension::length, 1e3},
    Unit{"um", Dimension::length, 1e-6, false},
    Unit{"\u00b5m", Dimension::length, 1e-6, false},  // the micro sign
    Unit{"\u03bcm", Dimension::length, 1e-6, false},  // the Greek letter, which looks the same
    Unit{"Pa", Dimension::pressure, 1},
    Unit{"kPa", Dimension::pressure, 1e3},
    Unit{"MPa", Dimension::pressure, 1e6},
    Unit{"GPa", Dimension::pressure, 1e9},
    Unit{"kN/m2", Dimension::pressure, 1e3},
    Unit{"MN/m2", Dimension::pressure, 1e6},
    Unit{"N/m2", Dimension::pressure, 1, false},
    Unit{"N/mm2", Dimension::pressure, 1e6, false},
    Unit{"N/m3", Dimension::unit_weight, 1},
    Unit{"kN/m3", Dimension::unit_weight, 1e3},
    Unit{"MN/m3", Dimension::unit_weight, 1e6},
    Unit{"kg/m3", Dimension::density, 1},
    Unit{"g/cm3", Dimension::density, 1e3},
    Unit{"t/m3", Dimension::density, 1e3},
    Unit{"rad", Dimension::angle, 1},
    Unit{"deg", Dimension::angle, degree},
};

/// For messages: "pressure in Pa, kPa, MPa". Other spellings of the same unit are left out.
std::string expectation(Dimension dimension) {
  if (dimension == Dimension::none) {
    return "a plain number or \"%\"";
  }
  std::string text;
  for (const Unit& unit : table) {
    if (unit.dimension == dimension && (unit.written || unit.symbol == "um")) {
      text += fmt::format("{}{}", text.empty() ? "" : ", ", unit.symbol);
    }
  }
  return fmt::format("{} in {}", dimension_name(dimension), text);
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string shortest(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.begin(), digits.end(), value).ptr;
  return {digits.begin(), end};
}

std::string joined(const std::string& number, std::string_view symbol) {
  return symbol.empty() ? number : fmt::format("{} {}", number, symbol);
}

}  // namespace

std::span<const Unit> units() { return table; }

std::string_view dimension_name(Dimension dimension) {
  switch (dimension) {
    case Dimension::none:
      return "dimensionless number";
    case Dimension::length:
      return "length";
    case Dimension::pressure:
      return "pressure";
    case Dimension::unit_weight:
      return "unit weight";
    case Dimension::density:
      return "density";
    case Dimension::angle:
      return "angle";
  }
  return "quantity";
}

std::string_view si_unit(Dimension dimension) {
  for (const Unit& unit : table) {
    if (unit.dimension == dimension && !unit.symbol.empty() && unit.factor == 1) {
      return unit.symbol;
    }
  }
  return "-";
}

double parse_quantity(std::string_view text, Dimension expected) {
  const std::string_view whole = trimmed(text);
  double value = 0;
  const auto [end, failure] = std::from_chars(whole.data(), whole.data() + whole.size(), value);
  const std::string shown = in_one_line(text);
  if (failure == std::errc::result_out_of_range) {
    throw UnitError(fmt::format("\"{}\" is too large or too small for a number", shown));
  }
  if (failure != std::errc{}) {
    throw UnitError(fmt::format("\"{}\" is no quantity, expected {}", shown, expectation(expected)));
  }
  if (!std::isfinite(value)) {
    throw UnitError(fmt::format("\"{}\" is not finite", shown));
  }
  const std::string_view symbol = trimmed(whole.substr(static_cast<std::size_t>(end - whole.data())));
  const Unit* found = nullptr;
  for (const Unit& unit : table) {
    if (unit.symbol == symbol && (found == nullptr || unit.dimension == expected)) {
      found = &unit;
    }
  }
  if (found == nullptr) {
    throw UnitError(fmt::format("unknown unit \"{}\", expected {}", in_one_line(symbol), expectation(expected)));
  }
  if (found->dimension != expected) {
    throw UnitError(symbol.empty() ? fmt::format("\"{}\" has no unit, expected {}", shown, expectation(expected))
                                   : fmt::format("\"{}\" is {} {}, expected {}", shown,
                                                 found->dimension == Dimension::angle ? "an" : "a",
                                                 dimension_name(found->dimension), expectation(expected)));
  }
  const double in_si = value * found->factor;
  if (!std::isfinite(in_si)) {
    throw UnitError(fmt::format("\"{}\" is not finite", shown));
  }
  return in_si;
}

std::string format_quantity(double in_si, Dimension dimension) {
  std::string best;
  for (const Unit& unit : table) {
    const double written = in_si / unit.factor;
    // A division may lose the last bit; a unit for which it does is passed over. The unit of factor 1 loses nothing.
    if (unit.written && unit.dimension == dimension && written * unit.factor == in_si) {
      const std::string candidate = joined(shortest(written), unit.symbol);
      if (best.empty() || candidate.size() < best.size()) {
        best = candidate;
      }
    }
  }
  return best;
}

}  // namespace voussoir::io
