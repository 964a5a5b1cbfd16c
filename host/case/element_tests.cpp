#include "host/case/element_tests.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "host/case/engine.hpp"
#include "host/case/keys.hpp"
#include "io/units.hpp"

namespace voussoir::host {

using io::Dimension;

BiaxialCase read_biaxial(const io::Table& table) {
  BiaxialCase test;
  test.pressures = table.quantities("pressures", Dimension::pressure, {.at_least = "100 Pa", .at_most = "10 MPa"},
                                    std::vector<std::string>{"100 kPa", "200 kPa", "400 kPa"});
  if (test.pressures.empty()) throw table.error("pressures", "names no pressure");
  if (test.pressures.size() > 1000) throw table.error("pressures", "names more than 1000 pressures");
  read_quantity(table, "strain", Dimension::none, test.strain, {.at_least = "1e-4", .at_most = "1"});
  read_quantity(table, "inertial_number", Dimension::none, test.inertial_number,
                {.at_least = "1e-6", .at_most = "1e-2"});
  read_quantity(table, "window", Dimension::none, test.window, {.at_least = "1e-5", .at_most = "0.1"});
  read_integer(table, "samples", test.samples, {.at_least = 20, .at_most = 100'000});
  if (test.strain < 2.0 * test.window) throw table.error("window", "is more than half of the strain");
  if (test.samples < 5.0 * test.strain / test.window)
    throw table.error("samples", "leaves fewer than five points in a window");
  for (std::size_t k = 1; k < test.pressures.size(); ++k) {
    if (std::find(test.pressures.begin(), test.pressures.begin() + static_cast<std::ptrdiff_t>(k), test.pressures[k]) !=
        test.pressures.begin() + static_cast<std::ptrdiff_t>(k)) {
      throw table.error("pressures", "names a pressure twice");
    }
  }
  return test;
}

namespace {

std::vector<PathSegment> read_path(const io::Table& table) {
  std::vector<PathSegment> path;
  for (const io::Table& entry : table.tables("path")) {
    PathSegment segment;
    const auto gradient = entry.quantities("gradient", Dimension::none, {.at_least = "-0.5", .at_most = "0.5"});
    if (gradient.size() != 4) throw entry.error("gradient", "must have the four entries xx, xy, yx, yy");
    std::copy(gradient.begin(), gradient.end(), segment.gradient.begin());
    read_integer(entry, "increments", segment.increments, {.at_least = 1, .at_most = 1'000'000});
    segment.constant_xx = entry.boolean("constant_xx", false);
    const auto [xx, xy, yx, yy] = segment.gradient;
    if (segment.constant_xx && xx != 0)
      throw entry.error("gradient", "must have no xx where constant_xx searches the xx");
    if (segment.constant_xx && xy == 0 && yx == 0 && yy == 0) {
      throw entry.error("gradient",
                        "must not be 0 where constant_xx searches its xx: the size of the gradient limits the search");
    }
    if (!((1 + xx) * (1 + yy) - xy * yx > 0))
      throw entry.error("gradient", "leaves no area: det(1 + gradient) must be positive");
    path.push_back(segment);
  }
  return path;
}

}  // namespace

ProbeCase read_probe(const io::Table& table) {
  ProbeCase probe;
  read_quantity(table, "pressure", Dimension::pressure, probe.pressure, {.at_least = "100 Pa", .at_most = "10 MPa"});
  read_quantity(table, "strain", Dimension::none, probe.strain, {.at_least = "1e-7", .at_most = "0.1"});
  read_integer(table, "replicas", probe.replicas, {.at_least = 1, .at_most = 10'000});
  probe.tangent = read_tangent(table, probe.tangent);
  probe.path = read_path(table);
  return probe;
}

namespace {

std::vector<double> read_list(const io::Table& table, const char* key, Dimension dimension, double of_soil,
                              const io::QuantityRule& rule) {
  std::vector<double> list = table.quantities(key, dimension, rule, std::vector<std::string>{});
  if (list.size() > 20) throw table.error(key, "has more than 20 entries, which no grid of tests can hold");
  for (std::size_t k = 1; k < list.size(); ++k) {
    if (list[k] <= list[k - 1]) throw table.error(key, "must ascend");
  }
  if (!list.empty() && !(of_soil > 0))
    throw table.error(key, "is searched but is 0 in [soil], so that the values of the classes have no ratio to it");
  return list;
}

void read_target(const io::Table& table, const std::string& name, CalibrationTarget& target) {
  read_quantity(table, name.c_str(), Dimension::angle, target.value, {.at_least = "0 deg", .at_most = "80 deg"});
  read_quantity(table, (name + "_tolerance").c_str(), Dimension::angle, target.tolerance,
                {.at_least = "0.001 deg", .at_most = "80 deg"});
}

}  // namespace

CalibrateCase read_calibrate(const io::Table& table, const SoilCase& soil) {
  CalibrateCase out;
  const io::QuantityRule rolling{.at_least = "1e-6", .at_most = "10"};  // a factor searches, which 0 cannot have
  out.rolling_stiffness = read_list(table, "rolling_stiffness", Dimension::none, soil.rolling_stiffness, rolling);
  out.rolling_limit = read_list(table, "rolling_limit", Dimension::none, soil.rolling_limit, rolling);
  out.thickness = read_list(table, "thickness", Dimension::length, soil.thickness,
                            {.at_least = "1 mm", .at_most = "100 m"});
  if (out.rolling_stiffness.size() < 2 && out.rolling_limit.size() < 2 && out.thickness.size() < 2) {
    throw table.error("rolling_stiffness", "leaves nothing to search: at least one parameter needs two values");
  }
  read_integer(table, "rounds", out.rounds, {.at_least = 0, .at_most = 10});
  read_target(table, "peak_angle", out.peak);
  read_target(table, "critical_angle", out.critical);
  read_target(table, "dilatancy_angle", out.dilatancy);
  read_quantity(table, "peak_strain_minimum", Dimension::none, out.peak_strain_minimum,
                {.at_least = "0", .at_most = "0.9"});
  read_quantity(table, "peak_strain_maximum", Dimension::none, out.peak_strain_maximum,
                {.at_least = "1e-5", .at_most = "1"});
  read_quantity(table, "peak_strain_tolerance", Dimension::none, out.peak_strain_tolerance,
                {.at_least = "1e-5", .at_most = "1"});
  if (out.peak_strain_maximum <= out.peak_strain_minimum) {
    throw table.error("peak_strain_maximum", "is not above peak_strain_minimum");
  }
  read_integer(table, "confirm_grains", out.confirm_grains, {.at_least = 30, .at_most = 20000});
  out.confirm_seeds = table.integers("confirm_seeds", {.at_least = 0, .at_most = 9'000'000'000'000'000},
                                     out.confirm_seeds);
  if (out.confirm_seeds.size() > 1000) throw table.error("confirm_seeds", "names more than 1000 seeds");
  if (out.confirm_seeds.size() < 2)
    throw table.error("confirm_seeds", "needs at least two seeds: one packing shows no scatter");
  if (std::set<std::int64_t>(out.confirm_seeds.begin(), out.confirm_seeds.end()).size() != out.confirm_seeds.size()) {
    throw table.error("confirm_seeds", "names a seed twice");
  }
  read_quantity(table, "confirm_inertial_number", Dimension::none, out.confirm_inertial_number,
                {.at_least = "1e-6", .at_most = "1e-2"});
  return out;
}

}  // namespace voussoir::host
