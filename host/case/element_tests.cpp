// The table [calibrate].
#include <set>
#include <string>
#include <vector>

#include "host/case/tables.hpp"
#include "io/units.hpp"

namespace voussoir::host {

using io::Dimension;

namespace {

std::vector<double> read_list(const io::Table& table, const char* key, Dimension dimension, double of_soil) {
  std::vector<double> list = table.quantities(key, dimension, {.positive = true}, std::vector<std::string>{});
  for (std::size_t k = 1; k < list.size(); ++k) {
    if (list[k] <= list[k - 1]) throw table.error(key, "must ascend");
  }
  if (!list.empty() && !(of_soil > 0))
    throw table.error(key, "is searched, but is 0 in [soil]: its classes have no ratios");
  return list;
}

void read_target(const io::Table& table, const std::string& name, CalibrationTarget& target) {
  read_quantity(table, name.c_str(), Dimension::angle, target.value, {.at_least = "0 deg", .at_most = "80 deg"});
  read_quantity(table, (name + "_tolerance").c_str(), Dimension::angle, target.tolerance, {.positive = true});
}

}  // namespace

CalibrateCase read_calibrate(const io::Table& table, const SoilCase& soil) {
  CalibrateCase out;
  out.rolling_stiffness = read_list(table, "rolling_stiffness", Dimension::none, soil.rolling_stiffness);
  out.rolling_limit = read_list(table, "rolling_limit", Dimension::none, soil.rolling_limit);
  out.thickness = read_list(table, "thickness", Dimension::length, soil.thickness);
  if (out.rolling_stiffness.size() < 2 && out.rolling_limit.size() < 2 && out.thickness.size() < 2) {
    throw table.error("rolling_stiffness", "nothing is searched: name at least two values of one parameter");
  }
  read_integer(table, "rounds", out.rounds, {.at_least = 0, .at_most = 10});
  read_target(table, "peak_angle", out.peak);
  read_target(table, "critical_angle", out.critical);
  read_target(table, "dilatancy_angle", out.dilatancy);
  read_quantity(table, "peak_strain_minimum", Dimension::none, out.peak_strain_minimum, {.at_least = "0"});
  read_quantity(table, "peak_strain_maximum", Dimension::none, out.peak_strain_maximum, {.positive = true});
  read_quantity(table, "peak_strain_tolerance", Dimension::none, out.peak_strain_tolerance, {.positive = true});
  if (out.peak_strain_maximum <= out.peak_strain_minimum) {
    throw table.error("peak_strain_maximum", "is not above peak_strain_minimum");
  }
  read_integer(table, "confirm_grains", out.confirm_grains, {.at_least = 30, .at_most = 20000});
  out.confirm_seeds = table.integers("confirm_seeds", {.at_least = 0}, out.confirm_seeds);
  if (out.confirm_seeds.size() < 2)
    throw table.error("confirm_seeds", "needs two seeds at least: one shows no scatter");
  if (std::set<std::int64_t>(out.confirm_seeds.begin(), out.confirm_seeds.end()).size() != out.confirm_seeds.size()) {
    throw table.error("confirm_seeds", "names a seed twice");
  }
  read_quantity(table, "confirm_inertial_number", Dimension::none, out.confirm_inertial_number,
                {.at_least = "1e-6", .at_most = "1e-2"});
  return out;
}

}  // namespace voussoir::host
