#include "io/packing_meta.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <vector>

#include "io/text_file.hpp"

namespace voussoir::io {

namespace {

using Json = nlohmann::json;

/// A fault of the file as a sentence.
struct MetaFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Parses the text and refuses a key that stands twice in an object: the parser itself would take the last one.
Json parse(const std::string& text) {
  std::vector<std::set<std::string>> open;
  const auto look = [&open](int, Json::parse_event_t event, Json& value) {
    if (event == Json::parse_event_t::object_start) {
      open.emplace_back();
    } else if (event == Json::parse_event_t::object_end) {
      open.pop_back();
    } else if (event == Json::parse_event_t::key && !open.back().insert(value.get<std::string>()).second) {
      throw MetaFault(fmt::format("has the key \"{}\" twice", in_one_line(value.get<std::string>(), 80)));
    }
    return true;
  };
  try {
    return Json::parse(text, look);
  } catch (const Json::exception& error) {
    const std::string said = error.what();
    const std::size_t end = said.find("] ");  // the name and the number of the exception stand in front
    throw MetaFault("is no JSON: " + in_one_line(end == std::string::npos ? said : said.substr(end + 2)));
  }
}

/// Numbers that the program compares with the grains or with the case; as texts they would pass unseen.
constexpr const char* known_numbers[] = {"N", "E", "kt_over_kn", "phi_deg", "alphaKr", "etaRoll", "damping"};

double number(const Json& value, const std::string& key) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    throw MetaFault(fmt::format("{} must be a finite number, is {}", key, in_one_line(value.dump(), 80)));
  }
  return value.get<double>();
}

/// Entry (row, column) of hSize, which is a matrix of two or three rows.
double entry(const Json& cell, std::size_t row, std::size_t column) {
  return number(cell.at(row).at(column), fmt::format("hSize[{}][{}]", row, column));
}

const Json& checked_cell(const Json& meta) {
  if (!meta.contains("hSize")) {
    throw MetaFault("lacks the key hSize, the matrix whose columns are the vectors of the cell [m]");
  }
  const Json& cell = meta["hSize"];
  const auto is_row = [&](const Json& row) { return row.is_array() && row.size() == cell.size(); };
  if (!cell.is_array() || (cell.size() != 2 && cell.size() != 3) || !std::all_of(cell.begin(), cell.end(), is_row)) {
    throw MetaFault(
        fmt::format("hSize must be a matrix of 3 x 3 (or 2 x 2) numbers, is {}", in_one_line(cell.dump(), 80)));
  }
  return cell;
}

void take(const Json& meta, Packing& packing) {
  if (!meta.is_object()) {
    throw MetaFault("must be an object with the key hSize");
  }
  const Json& cell = checked_cell(meta);
  packing.cell = {entry(cell, 0, 0), entry(cell, 0, 1), entry(cell, 1, 0), entry(cell, 1, 1)};
  if (!(packing.cell[0] * packing.cell[3] - packing.cell[1] * packing.cell[2] > 0)) {
    throw MetaFault("hSize: the cell must have a positive area");
  }
  const bool has_thickness = meta.contains("Lz");
  if (!has_thickness && cell.size() < 3) {
    throw MetaFault("lacks the key Lz, the thickness [m]");
  }
  packing.thickness = has_thickness ? number(meta["Lz"], "Lz") : entry(cell, 2, 2);
  if (!(packing.thickness > 0)) {
    throw MetaFault(fmt::format("{}: the thickness must be positive, is {}", has_thickness ? "Lz" : "hSize[2][2]",
                                packing.thickness));
  }
  for (const char* name : known_numbers) {
    if (meta.contains(name)) static_cast<void>(number(meta[name], name));
  }
  for (const auto& [name, value] : meta.items()) {
    if (value.is_number()) {
      packing.numbers[name] = value.get<double>();
    } else if (value.is_string()) {
      packing.labels[name] = value.get<std::string>();
    }
  }
  const auto count = packing.numbers.find("N");
  if (count != packing.numbers.end() && count->second != static_cast<double>(packing.grains())) {
    throw MetaFault(fmt::format("N says {} grains, but the particles file has {}", count->second, packing.grains()));
  }
}

}  // namespace

std::string take_packing_meta(const std::string& text, Packing& packing) {
  try {
    take(parse(text), packing);
  } catch (const MetaFault& fault) {
    return fault.what();
  }
  return "";
}

}  // namespace voussoir::io
