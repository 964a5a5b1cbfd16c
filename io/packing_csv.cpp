/// Reads packings of other codes from NAME_particles.csv and NAME_meta.json.

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "io/packing_file.hpp"

namespace voussoir::io {

namespace {

constexpr std::string_view header = "id,x_m,y_m,r_m,theta_z_rad";
constexpr std::string_view particles_ending = "_particles.csv";
constexpr std::string_view meta_ending = "_meta.json";

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& sentence) {
  throw std::runtime_error(fmt::format("{}: {}", path.string(), sentence));
}

std::ifstream opened(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path)) {
    fail(path, "cannot be read");
  }
  return file;
}

/// Reads five finite numbers that are separated by commas.
std::array<double, 5> parse_row(const std::string& line, const std::filesystem::path& path, int number) {
  std::array<double, 5> row{};
  const char* at = line.data();
  const char* const end = line.data() + line.size();
  for (std::size_t k = 0; k < row.size(); ++k) {
    const auto [next, failure] = std::from_chars(at, end, row[k]);
    const bool separated = k + 1 < row.size() ? next != end && *next == ',' : next == end;
    if (failure != std::errc{} || !separated || !std::isfinite(row[k])) {
      fail(path, fmt::format("line {}: must be five numbers ({})", number, header));
    }
    at = next + 1;
  }
  return row;
}

void read_particles(const std::filesystem::path& path, Packing& packing) {
  std::ifstream file = opened(path);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.ends_with('\r')) {
      line.pop_back();
    }
    if (number == 1) {
      if (line != header) {
        fail(path, fmt::format("line 1: must be \"{}\"", header));
      }
    } else if (!line.empty()) {
      const auto [id, x, y, radius, rotation] = parse_row(line, path, number);
      if (!(radius > 0)) {
        fail(path, fmt::format("line {}: radius must be positive, is {}", number, radius));
      }
      packing.x.push_back(x);
      packing.y.push_back(y);
      packing.radius.push_back(radius);
      packing.rotation.push_back(rotation);
    }
  }
  if (packing.radius.empty()) {
    fail(path, "has no grains");
  }
}

void read_meta(const std::filesystem::path& path, Packing& packing) {
  std::ifstream file = opened(path);
  try {
    const auto meta = nlohmann::json::parse(file);
    const auto& cell = meta.at("hSize");
    packing.cell = {cell.at(0).at(0).get<double>(), cell.at(0).at(1).get<double>(), cell.at(1).at(0).get<double>(),
                    cell.at(1).at(1).get<double>()};
    packing.thickness = meta.contains("Lz") ? meta["Lz"].get<double>() : cell.at(2).at(2).get<double>();
    for (const auto& [name, value] : meta.items()) {
      if (value.is_number()) {
        packing.numbers[name] = value.get<double>();
      } else if (value.is_string()) {
        packing.labels[name] = value.get<std::string>();
      }
    }
  } catch (const nlohmann::json::exception& error) {
    fail(path, error.what());
  }
  if (!(packing.cell[0] * packing.cell[3] - packing.cell[1] * packing.cell[2] > 0)) {
    fail(path, "hSize: the cell must have a positive area");
  }
  if (!(packing.thickness > 0)) {
    fail(path, fmt::format("the thickness must be positive, is {}", packing.thickness));
  }
}

}  // namespace

Packing load_packing_csv(const std::filesystem::path& path) {
  std::string stem = path.string();
  for (const auto ending : {particles_ending, meta_ending}) {
    if (stem.ends_with(ending)) {
      stem.resize(stem.size() - ending.size());
      Packing packing;
      read_particles(fmt::format("{}{}", stem, particles_ending), packing);
      read_meta(fmt::format("{}{}", stem, meta_ending), packing);
      return packing;
    }
  }
  fail(path, "must be named NAME_particles.csv or NAME_meta.json");
}

}  // namespace voussoir::io
