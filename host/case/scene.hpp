#pragma once
/// The input of the kind "scene": any plane-strain problem, said in five nouns (mesh, region, support, stage, record)
/// and one rule: a stage changes what it names, and all else stays as it stands. docs/explanation/scenes.md explains
/// them.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/case/case_parts.hpp"

namespace voussoir::host {

enum class MeshShape { file, grid, half_tunnel, tunnel, ring };
enum class RingPart { quarter, half, whole };

/// [mesh] A mesh file, or a shape; each shape uses the members below its name.
struct SceneMeshCase {
  MeshShape shape = MeshShape::grid;

  std::filesystem::path file;  ///< Gmsh file
  double unit = 1.0;           ///< length of 1 in the file [m]

  // grid: breakpoints, and for each interval between them the number of elements, the ratio of an element's length to
  // that of the one before it, and names.
  std::vector<double> x, y;                         ///< [m], ascending
  std::vector<std::int64_t> columns, rows;          ///< elements of each interval
  std::vector<double> x_ratio, y_ratio;             ///< [-]
  std::vector<std::string> base, top, left, right;  ///< names of the boundaries, by interval
  /// Names of the regions of a grid whose regions change along x, too: a row for each interval of y, upwards, with an
  /// entry for each interval of x; empty: `layers` counts.
  std::vector<std::vector<std::string>> regions;

  // half_tunnel, tunnel
  double width = 35.0, height = 35.0, diameter = 5.0, cover_ratio = 2.0;  ///< as in GroundCase; `tunnel`: whole width
  double size_opening = 0.6, size_far = 4.0;                              ///< [m]
  std::vector<double> interfaces;                                         ///< heights of lines between layers [m]

  std::vector<std::string> layers = {"ground"};  ///< names of regions, from the base upwards (grid, half_tunnel,
                                                 ///< tunnel)

  // ring about (0, 0); its boundaries are "cavity", "far", "x0" (x = 0; not of a whole ring) and "y0" (y = 0; of a
  // quarter); half a ring lies at x >= 0
  double radius = 1.0, outer = 10.0;  ///< [m]
  int ring_columns = 16;              ///< elements around
  int ring_rows = 16;                 ///< elements outwards
  double ratio = 1.0;                 ///< of an element's length to that of the one inside it [-]
  RingPart part = RingPart::quarter;
};

/// A point of the mesh by its name, or a place [m].
struct PlaceCase {
  std::string name;  ///< empty: `at` counts
  std::array<double, 2> at{};
};

/// [[region]] Named sets of elements and their material. Several names are several regions with the same settings.
struct RegionCase {
  std::vector<std::string> names = {};
  double unit_weight = 20.0e3;         ///< [N/m3]
  std::optional<ElasticCase> elastic;  ///< with a value: no grains here
  SoilCase soil;
  PackingCase packing;
};

/// [[support]] What holds boundaries or a point from the start.
struct SupportCase {
  std::vector<std::string> boundaries;  ///< empty: `point` counts
  PlaceCase point;
  bool x = false, y = false;
};

/// [[stage.move]] A boundary or a point that is moved; the axes that it names are held.
struct MoveCase {
  std::string boundary;  ///< empty: `point` counts
  PlaceCase point;
  std::optional<double> x, y;  ///< displacement at the stage's end [m]
  /// An affine motion u = (s R - 1)(X - about) with s = sqrt(1 + area): it holds both axes.
  std::optional<double> rotation;  ///< counter-clockwise [rad]
  std::optional<double> area;      ///< change of area over the area [-]
  PlaceCase about;
  [[nodiscard]] bool is_affine() const { return rotation || area; }
};

enum class PressKind { pressure, traction, at_rest };

/// [[stage.press]] The load of a boundary at the stage's end.
struct PressCase {
  std::string boundary;
  PressKind kind = PressKind::pressure;
  double pressure = 0;               ///< [Pa]
  std::array<double, 2> traction{};  ///< [Pa]
};

/// [[stage.release]] A boundary or a point that is no longer held: the forces that held it are taken off by `share`.
struct ReleaseCase {
  std::string boundary;  ///< empty: `point` counts
  PlaceCase point = {};
  double share = 1.0;  ///< [-]
};

/// [[stage.excavate]] Regions that are dug out: the forces that they put on the rest are taken off.
struct ExcavateCase {
  std::vector<std::string> regions = {};
};

/// [[stage]] What changes while the load parameter goes from 0 to `end`.
struct StageCase {
  std::string name;
  double end = 1;  ///< 1 in case files; kinds that are scenes inside count in their own parameter. Motions are those of
                   ///< a parameter of 1.
  int steps = 0;   ///< 0: the steps of [gravity]
  std::optional<double> gravity;  ///< load factor of the weights at the end [-]
  std::optional<double> tilt;     ///< of gravity from the vertical at the end [rad]
  LossGeometry geometry = LossGeometry::updated_lagrangian;
  std::vector<MoveCase> moves;
  std::vector<PressCase> presses;
  std::vector<ReleaseCase> releases;
  std::vector<ExcavateCase> excavations;

  /// Whether nothing but weights and tractions at rest changes.
  [[nodiscard]] bool only_gravity() const {
    for (const PressCase& press : presses)
      if (press.kind != PressKind::at_rest) return false;
    return moves.empty() && releases.empty() && excavations.empty();
  }
};

/// [[record]] One of: a point, a line, the means over one or several regions.
struct RecordCase {
  std::string name;
  std::optional<PlaceCase> point;
  std::optional<std::array<PlaceCase, 2>> line;
  int points = 50;                        ///< of a line
  std::vector<std::string> regions = {};  ///< empty: none
};

struct SceneCase {
  SceneMeshCase mesh;
  std::vector<RegionCase> regions;
  std::vector<SupportCase> supports;
  std::vector<StageCase> stages;
  std::vector<RecordCase> records;
};

}  // namespace voussoir::host
