// The tables of the grains: [soil], [packing], [engine], [probe].
#include <string>
#include <vector>

#include "host/case_tables.hpp"
#include "io/units.hpp"

namespace voussoir::host {

using io::Dimension;

void read_quantity(const io::Table& table, const char* key, Dimension dimension, double& member,
                   io::QuantityRule rule) {
  rule.fallback = io::format_quantity(member, dimension);
  member = table.quantity(key, dimension, rule);
}

void read_integer(const io::Table& table, const char* key, int& member, io::IntegerRule rule) {
  rule.fallback = member;
  member = static_cast<int>(table.integer(key, rule));
}

SoilCase read_soil(const io::Table& table) {
  SoilCase soil;
  read_quantity(table, "size_minimum", Dimension::length, soil.size_minimum, {.positive = true});
  read_quantity(table, "size_maximum", Dimension::length, soil.size_maximum, {.positive = true});
  if (soil.size_maximum < soil.size_minimum) throw table.error("size_maximum", "is smaller than size_minimum");
  if (soil.size_maximum > 40 * soil.size_minimum) {
    throw table.error("size_maximum", "is more than 40 times size_minimum: no RVE of this kind holds such a range");
  }
  read_quantity(table, "modulus", Dimension::pressure, soil.modulus, {.positive = true});
  read_quantity(table, "stiffness_ratio", Dimension::none, soil.stiffness_ratio, {.at_least = "0", .at_most = "2"});
  read_quantity(table, "friction", Dimension::angle, soil.friction, {.at_least = "0 deg", .at_most = "80 deg"});
  read_quantity(table, "rolling_stiffness", Dimension::none, soil.rolling_stiffness, {.at_least = "0"});
  read_quantity(table, "rolling_limit", Dimension::none, soil.rolling_limit, {.at_least = "0"});
  read_quantity(table, "damping", Dimension::none, soil.damping, {.at_least = "0", .at_most = "0.9"});
  read_quantity(table, "density", Dimension::density, soil.density, {.positive = true});
  read_quantity(table, "thickness", Dimension::length, soil.thickness, {.positive = true});
  return soil;
}

PackingCase read_packing(const io::Table& table) {
  PackingCase packing;
  read_integer(table, "grains", packing.grains, {.at_least = 30, .at_most = 20000});
  packing.seed = table.integer("seed", {.fallback = packing.seed, .at_least = 0});
  packing.seeds = table.integers("seeds", {.at_least = 0}, std::vector<std::int64_t>{});
  read_integer(table, "candidates", packing.candidates, {.at_least = 1, .at_most = 1000});
  read_quantity(table, "consolidation_friction", Dimension::none, packing.consolidation_friction,
                {.at_least = "0", .at_most = "2"});
  read_quantity(table, "pressure", Dimension::pressure, packing.pressure, {.at_least = "100 Pa", .at_most = "10 MPa"});
  packing.mirrored = table.boolean("mirrored", packing.mirrored);
  packing.folder = table.text("folder", packing.folder.string());
  if (table.has("file")) packing.file = table.path("file");
  return packing;
}

EngineCase read_engine(const io::Table& table) {
  EngineCase engine;
  engine.precision = table.choice("precision", {"float", "double"}, "float") == "float" ? Precision::single_precision
                                                                                        : Precision::double_precision;
  read_quantity(table, "inertial_number", Dimension::none, engine.inertial_number,
                {.at_least = "1e-6", .at_most = "1e-2"});
  read_quantity(table, "hold_tolerance", Dimension::none, engine.hold_tolerance,
                {.at_least = "1e-6", .at_most = "0.1"});
  read_integer(table, "hold_cap", engine.hold_cap, {.at_least = 0, .at_most = 10'000'000});
  read_quantity(table, "skin", Dimension::none, engine.skin, {.at_least = "0.005", .at_most = "1"});
  read_integer(table, "minimum_steps", engine.minimum_steps, {.at_least = 1, .at_most = 10'000'000});
  read_integer(table, "maximum_steps", engine.maximum_steps, {.at_least = 1, .at_most = 10'000'000});
  if (engine.maximum_steps < engine.minimum_steps) throw table.error("maximum_steps", "is smaller than minimum_steps");
  return engine;
}

BiaxialCase read_biaxial(const io::Table& table) {
  BiaxialCase test;
  test.pressures = table.quantities("pressures", Dimension::pressure, {.at_least = "100 Pa", .at_most = "10 MPa"},
                                    std::vector<std::string>{"100 kPa", "200 kPa", "400 kPa"});
  if (test.pressures.empty()) throw table.error("pressures", "names no pressure");
  read_quantity(table, "strain", Dimension::none, test.strain, {.at_least = "1e-4", .at_most = "1"});
  read_quantity(table, "inertial_number", Dimension::none, test.inertial_number, {.at_least = "1e-6", .at_most = "1e-2"});
  read_quantity(table, "window", Dimension::none, test.window, {.at_least = "1e-5", .at_most = "0.1"});
  read_integer(table, "samples", test.samples, {.at_least = 20, .at_most = 100'000});
  return test;
}

ProbeCase read_probe(const io::Table& table) {
  ProbeCase probe;
  read_quantity(table, "pressure", Dimension::pressure, probe.pressure, {.at_least = "100 Pa", .at_most = "10 MPa"});
  read_quantity(table, "strain", Dimension::none, probe.strain, {.at_least = "1e-7", .at_most = "0.1"});
  return probe;
}

}  // namespace voussoir::host
