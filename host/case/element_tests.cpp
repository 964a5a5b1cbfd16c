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
  test.pressures = table.quantities({"pressures", "Confining pressures; one test is run at each, on each packing."},
                                    Dimension::pressure, {.at_least = "100 Pa", .at_most = "10 MPa"},
                                    std::vector<std::string>{"100 kPa", "200 kPa", "400 kPa"},
                                    {.least = 1, .most = 1000, .different = true});
  read_quantity(table, {"strain", "Logarithmic axial strain at the end of a test."}, Dimension::none, test.strain,
                {.at_least = "1e-4", .at_most = "1"});
  read_quantity(table,
                {"inertial_number",
                 "Inertial number of the axial strain rate at the confining pressure; smaller values are nearer to "
                 "quasi-static loading and cost more steps."},
                Dimension::none, test.inertial_number, {.at_least = "1e-6", .at_most = "1e-2"});
  read_quantity(table,
                {"window",
                 "Axial strain over which curves are smoothed before the strength and the dilatancy are read from "
                 "them; at most half of `strain`."},
                Dimension::none, test.window, {.at_least = "1e-5", .at_most = "0.1"});
  read_integer(table, {"samples", "Number of points of a curve, at least five in each window."}, test.samples,
               {.at_least = 20, .at_most = 100'000});
  if (test.strain < 2.0 * test.window) throw table.error("window", "is more than half of the strain");
  if (test.samples < 5.0 * test.strain / test.window)
    throw table.error("samples", "leaves fewer than five points in a window");
  return test;
}

namespace {

std::vector<PathSegment> read_path(const io::Table& table) {
  std::vector<PathSegment> path;
  for (const io::Table& entry : table.tables({"path",
                                              "Segments of the strain path that the packing is led along before it is "
                                              "probed, as a mesh would strain it."})) {
    PathSegment segment;
    const auto gradient = entry.quantities(
        {"gradient",
         "Displacement gradient of one increment, as the four entries xx, xy, yx, yy. Extension is positive, and the "
         "determinant of 1 + gradient must be positive."},
        Dimension::none, {.at_least = "-0.5", .at_most = "0.5"}, {}, {.least = 4, .most = 4});
    std::copy(gradient.begin(), gradient.end(), segment.gradient.begin());
    read_integer(entry, {"increments", "Number of times that `gradient` is put on."}, segment.increments,
                 {.at_least = 1, .at_most = 1'000'000});
    segment.constant_xx = entry.boolean({"constant_xx",
                                         "Holds the horizontal stress: the entry xx of the gradient, which must be "
                                         "given as 0, is searched, and one of the others must not be 0."},
                                        false);
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
  read_quantity(table, {"pressure", "Isotropic pressure of the packing."}, Dimension::pressure, probe.pressure,
                {.at_least = "100 Pa", .at_most = "10 MPa"});
  read_quantity(table, {"strain", "Size of each probe, which is a small displacement gradient."}, Dimension::none,
                probe.strain, {.at_least = "1e-7", .at_most = "0.1"});
  read_integer(table,
               {"replicas",
                "Number of copies of path and probes whose gradients differ by 1e-6 of their size. Their answers "
                "scatter as the chaotic motion of grains makes them, so that the scatter of an answer becomes known."},
               probe.replicas, {.at_least = 1, .at_most = 10'000});
  probe.tangent = read_tangent(table,
                               {"tangent",
                                "Tangent that the report compares with the responses to the probes (`newton.tangent` "
                                "explains the names); a `loading` tangent is one for probes of the size `strain`."},
                               probe.tangent);
  probe.path = read_path(table);
  return probe;
}

namespace {

std::vector<double> read_list(const io::Table& table, const io::Key& key, Dimension dimension, double of_soil,
                              const io::QuantityRule& rule) {
  std::vector<double> list = table.quantities(key, dimension, rule, std::vector<std::string>{}, {.most = 20});
  table.expect_order(key.name, list, io::Order::ascending);
  if (!list.empty() && !(of_soil > 0))
    throw table.error(key.name,
                      "is searched but is 0 in [soil], so that the values of the classes have no ratio to it");
  return list;
}

void read_target(const io::Table& table, const io::Key& value, const io::Key& tolerance, CalibrationTarget& target) {
  read_quantity(table, value, Dimension::angle, target.value, {.at_least = "0 deg", .at_most = "80 deg"});
  read_quantity(table, tolerance, Dimension::angle, target.tolerance, {.at_least = "0.001 deg", .at_most = "80 deg"});
}

}  // namespace

CalibrateCase read_calibrate(const io::Table& table, const SoilCase& soil) {
  CalibrateCase out;
  const io::QuantityRule rolling{.at_least = "1e-6", .at_most = "10"};  // a factor searches, which 0 cannot have
  out.rolling_stiffness = read_list(
      table,
      {"rolling_stiffness",
       "Values of `soil.rolling_stiffness` on the first grid of the search, ascending. A list of one value fixes it at "
       "this value, and without the key it is that of `[soil]`; at least one of the three lists needs two values."},
      Dimension::none, soil.rolling_stiffness, rolling);
  out.rolling_limit = read_list(
      table, {"rolling_limit", "Values of `soil.rolling_limit` on the first grid of the search, in the same way."},
      Dimension::none, soil.rolling_limit, rolling);
  out.thickness = read_list(
      table, {"thickness", "Values of `soil.thickness` on the first grid of the search, in the same way."},
      Dimension::length, soil.thickness, {.at_least = "1 mm", .at_most = "100 m"});
  if (out.rolling_stiffness.size() < 2 && out.rolling_limit.size() < 2 && out.thickness.size() < 2) {
    throw table.error("rolling_stiffness", "leaves nothing to search: at least one parameter needs two values");
  }
  read_integer(
      table,
      {"rounds", "Number of refinements of the search after its first grid, each around the best of all tests so far."},
      out.rounds, {.at_least = 0, .at_most = 10});
  read_target(table, {"peak_angle", "Peak friction angle that the tests shall show."},
              {"peak_angle_tolerance",
               "Difference from the peak friction angle that adds 1 to the misfit, which is a sum of squares."},
              out.peak);
  read_target(table, {"critical_angle", "Friction angle at the critical state that the tests shall show."},
              {"critical_angle_tolerance",
               "Difference from the friction angle at the critical state that adds 1 to the misfit."},
              out.critical);
  read_target(table, {"dilatancy_angle", "Largest angle of dilatancy that the tests shall show."},
              {"dilatancy_angle_tolerance", "Difference from the angle of dilatancy that adds 1 to the misfit."},
              out.dilatancy);
  read_quantity(table,
                {"peak_strain_minimum",
                 "Smallest axial strain at the peak that adds nothing to the misfit, as the mean over the pressures."},
                Dimension::none, out.peak_strain_minimum, {.at_least = "0", .at_most = "0.9"});
  read_quantity(table,
                {"peak_strain_maximum",
                 "Largest axial strain at the peak that adds nothing to the misfit, as the mean over the pressures."},
                Dimension::none, out.peak_strain_maximum, {.at_least = "1e-5", .at_most = "1"});
  read_quantity(
      table, {"peak_strain_tolerance", "Distance of the strain at the peak from its limits that adds 1 to the misfit."},
      Dimension::none, out.peak_strain_tolerance, {.at_least = "1e-5", .at_most = "1"});
  if (out.peak_strain_maximum <= out.peak_strain_minimum) {
    throw table.error("peak_strain_maximum", "is not above peak_strain_minimum");
  }
  read_integer(table,
               {"confirm_grains",
                "Number of grains of the packings on which the best values, and those of `[soil]` as given, are tested "
                "at the end."},
               out.confirm_grains, {.at_least = 30, .at_most = 20000});
  out.confirm_seeds = table.integers(
      {"confirm_seeds",
       "Seeds of the packings of these last tests, at least two, because one packing shows no scatter."},
      {.at_least = 0, .at_most = 9'000'000'000'000'000}, out.confirm_seeds,
      {.least = 2, .most = 1000, .different = true});
  read_quantity(table, {"confirm_inertial_number", "Inertial number of these last tests."}, Dimension::none,
                out.confirm_inertial_number, {.at_least = "1e-6", .at_most = "1e-2"});
  return out;
}

}  // namespace voussoir::host
