#include "host/sweep/run_results.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

using Columns = std::map<std::string, io::TableColumn>;

Columns by_name(const std::vector<io::TableColumn>& columns) {
  Columns found;
  for (const io::TableColumn& column : columns) found[column.name] = column;
  return found;
}

void add_mesh_results(io::SweepRow& row, const MemberResults& run) {
  const io::IncrementInfo& last = run.increments.back();
  row.stage = last.stage;
  row.load_parameter = last.load_parameter;
  for (const io::IncrementInfo& info : run.increments) {
    row.iterations += info.iterations;
    row.particle_steps += info.particle_steps;
    row.wall_time += info.wall_s;
  }
  row.results = last.extra;
  row.results.erase("volume_loss");  // it repeats the load parameter of the stage "volume_loss"
}

/// The mean of a column over the packings (of their means over the valid tests), and its standard error over them.
void add_mean(io::Quantities& results, const io::TableColumn& column, const Columns& table) {
  const std::vector<double>& seeds = table.at("seed").values;
  const std::vector<double>& valid = table.at("valid").values;
  std::map<double, std::vector<double>> of_packing;
  for (std::size_t test = 0; test < seeds.size(); ++test) {
    if (valid[test] > 0 && std::isfinite(column.values[test])) of_packing[seeds[test]].push_back(column.values[test]);
  }
  if (of_packing.empty()) return;
  std::vector<double> means;
  for (const auto& [seed, values] : of_packing) {
    double sum = 0;
    for (const double value : values) sum += value;
    means.push_back(sum / static_cast<double>(values.size()));
  }
  const auto count = static_cast<double>(means.size());
  double mean = 0, squares = 0;
  for (const double value : means) mean += value / count;
  for (const double value : means) squares += (value - mean) * (value - mean);
  results[column.name] = {mean, column.unit};
  if (means.size() > 1) results[column.name + "_error"] = {std::sqrt(squares / ((count - 1) * count)), column.unit};
}

void add_strength(io::SweepRow& row, const Columns& table) {
  constexpr std::array<const char*, 5> wanted{"peak_angle", "critical_angle", "dilatancy_angle", "peak_strain",
                                              "contraction"};
  for (const char* name : wanted) {
    if (const auto column = table.find(name); column != table.end()) add_mean(row.results, column->second, table);
  }
  const std::vector<double>& valid = table.at("valid").values;
  row.results["tests"] = {static_cast<double>(valid.size()), "-"};
  row.results["valid_tests"] = {
      static_cast<double>(std::count_if(valid.begin(), valid.end(), [](double is_valid) { return is_valid > 0; })),
      "-"};
}

}  // namespace

std::optional<MemberResults> add_results(io::SweepRow& row, const std::filesystem::path& folder) {
  const std::filesystem::path index = folder / "run.h5";
  if (!std::filesystem::exists(index)) return std::nullopt;
  if (!io::read_increments(index).empty()) {
    MemberResults run = read_member(folder);
    add_mesh_results(row, run);
    return run;
  }
  const io::Tables tables = io::read_tables(index);
  if (const auto strength = tables.find("strength"); strength != tables.end())
    add_strength(row, by_name(strength->second));
  if (const auto fit = tables.find("fit"); fit != tables.end()) {
    for (const io::TableColumn& column : fit->second) {
      if (!column.values.empty()) row.results[column.name] = {column.values.front(), column.unit};
    }
  }
  return std::nullopt;
}

}  // namespace voussoir::host
