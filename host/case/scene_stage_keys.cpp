#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "host/case/keys.hpp"
#include "host/case/scene_keys.hpp"
#include "host/case/tables.hpp"

namespace voussoir::host {

using io::Dimension;

namespace {

/// Reads the boundary or the point that a table changes, of which it has one.
template <class Change>
void read_target(const io::Table& entry, const io::Key& boundary_key, const io::Key& point_key, Change& change) {
  change.boundary = entry.optional_text(boundary_key, column_name_rule).value_or("");
  const auto point = read_place(entry, point_key);
  if (change.boundary.empty() == !point) throw entry.error(point ? "point" : "", "must have one of boundary and point");
  if (point) change.point = *point;
}

MoveCase read_move(const io::Table& entry) {
  MoveCase move;
  read_target(
      entry, {"boundary", "Boundary that is moved, unless a point is."},
      {"point",
       "Point that is moved: its name in the mesh, or coordinates, where a node of the mesh as drawn must lie."},
      move);
  move.x = entry.optional_quantity({"x",
                                    "Displacement along x at the stage's end, counted from its beginning; with 0 the "
                                    "boundary is held where it is."},
                                   Dimension::length, coordinate_rule);
  move.y = entry.optional_quantity(
      {"y", "Displacement along y at the stage's end, counted from its beginning, in the same way."}, Dimension::length,
      coordinate_rule);
  move.rotation = entry.optional_quantity({"rotation",
                                           "Angle by which the boundary is turned about `about`, counter-clockwise, at "
                                           "the stage's end. It holds both axes."},
                                          Dimension::angle, {.at_least = "-90 deg", .at_most = "90 deg"});
  move.area = entry.optional_quantity(
      {"area",
       "Change of the area within the boundary, over this area, at the stage's end: the boundary shrinks to or grows "
       "from `about` and keeps its shape, as a tunnel with a volume loss does. It holds both axes."},
      Dimension::none, {.at_least = "-0.9", .at_most = "100"});
  const auto about = read_place(
      entry, {"about", "Centre of `rotation` and `area`: the name of a point of the mesh, or coordinates."});
  if (!move.is_affine()) {
    if (!move.x && !move.y) throw entry.error("", "moves nothing: it needs x, y, rotation or area");
    if (about) throw entry.error("about", "is given without rotation or area, whose centre it is");
    return move;
  }
  const char* affine = move.rotation ? "rotation" : "area";
  if (move.x || move.y)
    throw entry.error(move.x ? "x" : "y", fmt::format("is given beside {}, which holds both axes", affine));
  if (move.boundary.empty()) throw entry.error(affine, "is for a boundary: a point moves by x and y");
  if (!about) throw entry.error("about", fmt::format("is missing: it is the centre of {}", affine));
  move.about = *about;
  return move;
}

PressCase read_press(const io::Table& entry) {
  PressCase press;
  press.boundary = entry.text({"boundary", "Boundary that is loaded."}, {}, column_name_rule);
  const auto pressure = entry.optional_quantity(
      {"pressure", "Normal pressure at the stage's end, compression positive; it follows the boundary as it moves."},
      Dimension::pressure, {.at_least = "0 Pa", .at_most = "10 GPa"});
  const std::vector<double> traction = entry.quantities(
      {"traction", "Traction at the stage's end, its components along x and y, on the boundary as it lies."},
      Dimension::pressure, {.at_least = "-10 GPa", .at_most = "10 GPa"}, std::vector<std::string>{}, {.most = 2});
  const bool at_rest = entry.boolean(
      {"at_rest",
       "Loads the boundary with the tractions that level ground at rest would put on it under the stage's load factor. "
       "K0 is measured on a column of the same layers before (`[column]`)."},
      false);
  if ((pressure ? 1 : 0) + (traction.empty() ? 0 : 1) + (at_rest ? 1 : 0) != 1)
    throw entry.error("", "must have one of pressure, traction and at_rest = true");
  if (!traction.empty() && traction.size() != 2)
    throw entry.error("traction", "must have two entries, along x and along y");
  if (at_rest) press.kind = PressKind::at_rest;
  if (pressure) press.pressure = *pressure;
  if (traction.empty()) return press;
  press.kind = PressKind::traction;
  press.traction = {traction[0], traction[1]};
  return press;
}

ReleaseCase read_release(const io::Table& entry) {
  ReleaseCase release;
  read_target(entry, {"boundary", "Boundary that is released, unless a point is."},
              {"point",
               "Point that is released, which a support or a stage has held as a point: its name in the mesh, or "
               "coordinates, where a node of the mesh as drawn must lie."},
              release);
  read_quantity(entry,
                {"share",
                 "Share of the forces that held the boundary or the point at the stage's beginning which is taken "
                 "off; the rest stays as a load."},
                Dimension::none, release.share, {.at_least = "1e-6", .at_most = "1"});
  return release;
}

/// Refuses that two tables of one kind name the same thing in one stage.
void check_once(const io::Table& entry, const char* key, const std::string& name, std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end())
    throw entry.error(key, fmt::format("names '{}' for the second time in this stage", name));
  known.push_back(name);
}

void read_changes(const io::Table& entry, StageCase& stage) {
  std::vector<std::string> pressed, released, dug;
  for (const io::Table& move : entry.tables(tables::stage_move)) stage.moves.push_back(read_move(move));
  for (const io::Table& press : entry.tables(tables::stage_press)) {
    stage.presses.push_back(read_press(press));
    check_once(press, "boundary", stage.presses.back().boundary, pressed);
  }
  for (const io::Table& release : entry.tables(tables::stage_release)) {
    stage.releases.push_back(read_release(release));
    if (!stage.releases.back().boundary.empty())
      check_once(release, "boundary", stage.releases.back().boundary, released);
  }
  for (const io::Table& excavate : entry.tables(tables::stage_excavate)) {
    stage.excavations.push_back({excavate.texts({"region", "Region that is dug out, or an array of regions."}, {},
                                                column_name_rule, {.least = 1, .different = true, .or_one = true})});
    for (const std::string& name : stage.excavations.back().regions) check_once(excavate, "region", name, dug);
  }
}

bool has_at_rest(const StageCase& stage) {
  return std::any_of(stage.presses.begin(), stage.presses.end(),
                     [](const PressCase& press) { return press.kind == PressKind::at_rest; });
}

/// Reads `steps`, which a stage needs unless [gravity] says how its load factor grows.
void read_steps(const io::Table& entry, StageCase& stage) {
  const auto steps = entry.optional_integer(
      {"steps",
       "Number of equal increments of the stage. A stage that only puts gravity on must not have the key: `[gravity]` "
       "says its increments."},
      {.at_least = 1, .at_most = 100'000, .default_words = "none in a stage of gravity alone, else it must be given"});
  const bool by_gravity = stage.gravity && stage.only_gravity();
  if (by_gravity && steps)
    throw entry.error("steps", "is for stages that do more: [gravity] says the steps of this one");
  if (!by_gravity && !steps) throw entry.error("steps", "is missing");
  stage.steps = static_cast<int>(steps.value_or(0));
}

void read_geometry(const io::Table& entry, StageCase& stage) {
  const std::string geometry = entry.choice(
      {"geometry",
       "Whether the mesh moves with the ground in this stage (`updated_lagrangian`), or strains and equilibrium are "
       "those of the mesh as it lies at the stage's beginning (`fixed_mesh`), where displacements begin at 0 again "
       "after the stage."},
      {"updated_lagrangian", "fixed_mesh"}, stage.only_gravity() ? "fixed_mesh" : "updated_lagrangian",
      "`fixed_mesh` where only weights and tractions at rest change, else `updated_lagrangian`");
  stage.geometry = geometry == "fixed_mesh" ? LossGeometry::fixed_mesh : LossGeometry::updated_lagrangian;
  if (stage.geometry == LossGeometry::fixed_mesh && !stage.only_gravity())
    throw entry.error("geometry", "\"fixed_mesh\" is for stages in which only weights and tractions at rest change");
}

/// The weights as a stage leaves them.
struct Weights {
  double gravity = 0, tilt = 0;
};

void check_changes(const io::Table& entry, const StageCase& stage, Weights& weights) {
  const Weights before = weights;
  weights = {stage.gravity.value_or(before.gravity), stage.tilt.value_or(before.tilt)};
  const bool has_weights_changed = weights.gravity != before.gravity || weights.tilt != before.tilt;
  if (stage.gravity && weights.gravity == before.gravity && stage.only_gravity())
    throw entry.error("gravity", fmt::format("is {:g} already before this stage", before.gravity));
  if (has_at_rest(stage) && weights.gravity == 0)
    throw entry.error("press", "has at_rest = true, but no weight acts in this stage: gravity is 0");
  const bool has_load = std::any_of(stage.presses.begin(), stage.presses.end(), [](const PressCase&) { return true; });
  if (!has_weights_changed && !has_load && stage.moves.empty() && stage.releases.empty() && stage.excavations.empty())
    throw entry.error("", "changes nothing: it needs gravity, tilt, or a table move, press, release or excavate");
}

StageCase read_stage(const io::Table& entry, Weights& weights) {
  StageCase stage;
  stage.name = entry.text({"name", "Name of the stage in the log and the results."}, {}, column_name_rule);
  stage.gravity = entry.optional_quantity({"gravity",
                                           "Load factor on the unit weights at the stage's end: 1 is the ground's own "
                                           "weight. Without the key it stays what "
                                           "it was, which is 0 before the first stage."},
                                          Dimension::none, {.at_least = "0", .at_most = "1000"});
  stage.tilt = entry.optional_quantity({"tilt",
                                        "Direction of gravity from the vertical at the stage's end; a positive angle "
                                        "turns it counter-clockwise, towards "
                                        "+x. Without the key it stays what it was, which is 0 before the first stage."},
                                       Dimension::angle, {.at_least = "-80 deg", .at_most = "80 deg"});
  read_changes(entry, stage);
  check_changes(entry, stage, weights);
  read_steps(entry, stage);
  read_geometry(entry, stage);
  return stage;
}

/// Refuses that a stage digs out what an earlier one has taken away. `gone` has the stage of each region.
void check_dug(const io::Table& entry, const StageCase& stage, std::map<std::string, std::string>& gone) {
  for (std::size_t k = 0; k < stage.excavations.size(); ++k) {
    for (const std::string& name : stage.excavations[k].regions) {
      const auto [before, is_new] = gone.try_emplace(name, stage.name);
      if (!is_new)
        throw entry.known_tables("excavate")[k].error(
            "region", fmt::format("names '{}', which stage '{}' has dug out", name, before->second));
    }
  }
}

}  // namespace

std::vector<StageCase> read_stages(const io::Table& root) {
  std::vector<StageCase> stages;
  std::vector<std::string> names;
  std::map<std::string, std::string> gone;
  Weights weights;
  for (const io::Table& entry : root.tables(tables::stage)) {
    StageCase stage = read_stage(entry, weights);
    check_new_name(entry, stage.name, names);
    check_dug(entry, stage, gone);
    names.push_back(stage.name);
    stages.push_back(std::move(stage));
  }
  if (stages.empty()) throw root.error("stage", "is missing: a scene needs at least one [[stage]]");
  return stages;
}

}  // namespace voussoir::host
