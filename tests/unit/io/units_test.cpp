/// Units of case files: every unit, exact round trips, and what a wrong one is told.

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <set>

#include "io/units.hpp"

namespace voussoir::io {
namespace {

std::string message(std::string_view text, Dimension expected) {
  try {
    static_cast<void>(parse_quantity(text, expected));
  } catch (const UnitError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Units, ValuesOfTheUnitsPeopleWrite) {
  EXPECT_DOUBLE_EQ(parse_quantity("5 mm", Dimension::length), 0.005);
  EXPECT_DOUBLE_EQ(parse_quantity("20 kN/m3", Dimension::unit_weight), 2e4);
  EXPECT_DOUBLE_EQ(parse_quantity("25 deg", Dimension::angle), 25 * std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(parse_quantity("1 kPa", Dimension::pressure), 1e3);
  EXPECT_DOUBLE_EQ(parse_quantity("3 GPa", Dimension::pressure), 3e9);
  EXPECT_DOUBLE_EQ(parse_quantity("0.25 %", Dimension::none), 0.0025);
  EXPECT_DOUBLE_EQ(parse_quantity("2650 kg/m3", Dimension::density), 2650);
  EXPECT_DOUBLE_EQ(parse_quantity("2 g/cm3", Dimension::density), 2000);
  EXPECT_DOUBLE_EQ(parse_quantity("  -1.5e-3  ", Dimension::none), -1.5e-3);
  EXPECT_DOUBLE_EQ(parse_quantity("5mm", Dimension::length), 0.005);
  for (const char* text : {"250 um", "250 \u00b5m", "250 \u03bcm"}) {
    EXPECT_DOUBLE_EQ(parse_quantity(text, Dimension::length), 2.5e-4) << text;
  }
  EXPECT_DOUBLE_EQ(parse_quantity("30 N/mm2", Dimension::pressure), 3e7);
}

TEST(Units, SymbolsAreUniqueAndEachDimensionHasItsSiUnit) {
  std::set<std::string_view> symbols;
  std::set<Dimension> with_si_unit;
  for (const Unit& unit : units()) {
    EXPECT_TRUE(symbols.insert(unit.symbol).second) << unit.symbol;
    EXPECT_GT(unit.factor, 0) << unit.symbol;
    if (unit.factor == 1) {
      with_si_unit.insert(unit.dimension);
    }
  }
  for (const Unit& unit : units()) {
    EXPECT_TRUE(with_si_unit.contains(unit.dimension)) << unit.symbol;
  }
}

TEST(Units, WrongDimensionNamesWhatIsExpected) {
  EXPECT_EQ(message("5 kPa", Dimension::length), "\"5 kPa\" is a pressure, expected length in m, cm, mm, km, um");
  EXPECT_EQ(message("5", Dimension::angle), "\"5\" has no unit, expected angle in rad, deg");
  EXPECT_EQ(message("5 furlong", Dimension::angle), "unknown unit \"furlong\", expected angle in rad, deg");
  EXPECT_EQ(message("5 mm", Dimension::none), "\"5 mm\" is a length, expected a plain number or \"%\"");
}

TEST(Units, NonsenseIsRefused) {
  for (const char* text : {"", "mm", "abc", "- 5 mm"}) {
    EXPECT_EQ(message(text, Dimension::length),
              std::string("\"") + text + "\" is no quantity, expected length in m, cm, mm, km, um");
  }
  for (const char* text : {"nan mm", "inf mm", "1e306 km"}) {
    EXPECT_EQ(message(text, Dimension::length), std::string("\"") + text + "\" is not finite");
  }
  for (const char* text : {"1e400 mm", "1e-400 mm"}) {
    EXPECT_EQ(message(text, Dimension::length), std::string("\"") + text + "\" is too large or too small for a number");
  }
  EXPECT_EQ(message("5 mm mm", Dimension::length), "unknown unit \"mm mm\", expected length in m, cm, mm, km, um");
  EXPECT_EQ(message("0x10 mm", Dimension::length), "unknown unit \"x10 mm\", expected length in m, cm, mm, km, um");
}

TEST(Units, FormatIsShortAndGivesBackTheSameBits) {
  EXPECT_EQ(format_quantity(0.002375, Dimension::length), "2.375 mm");
  EXPECT_EQ(format_quantity(35, Dimension::length), "35 m");
  EXPECT_EQ(format_quantity(2e4, Dimension::unit_weight), "20 kN/m3");
  EXPECT_EQ(format_quantity(parse_quantity("25 deg", Dimension::angle), Dimension::angle), "25 deg");
  EXPECT_EQ(format_quantity(0.6, Dimension::none), "0.6");
  // Resolved cases are written as before there was a micrometre, so that results keep their fingerprints.
  EXPECT_EQ(format_quantity(5e-5, Dimension::length), "5e-05 m");
  for (const Unit& unit : units()) {
    for (const double value : {1.0 / 3, 0.1, 7e-9, 123456.789, -0.0025, std::numeric_limits<double>::max() / 1e9}) {
      EXPECT_EQ(parse_quantity(format_quantity(value, unit.dimension), unit.dimension), value);
    }
  }
}

}  // namespace
}  // namespace voussoir::io
