#pragma once
/// The plain data of a run's results: mesh, provenance, fields, increments, tables, whole RVEs. docs/reference/files.md
/// says how they stand in files; result_file.hpp writes and reads them.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace voussoir::io {

/// A mesh of 8-node quadrilaterals: corners 0-3 counter-clockwise, then midsides 4 (0-1), 5 (1-2), 6 (2-3), 7 (3-0),
/// the order of Gmsh, VTK and XDMF.
struct MeshData {
  std::vector<double> coordinates = {};                                            ///< (node, 2) [m]
  std::vector<std::int64_t> connectivity = {};                                     ///< (element, 8), counted from 0
  std::vector<std::pair<std::string, std::vector<std::int64_t>>> boundaries = {};  ///< name, nodes in order along it
  std::map<std::string, std::int64_t> points = {};  ///< nodes with names, such as "crown" of a tunnel
  std::map<std::string, double> geometry = {};      ///< further numbers: axis_depth, diameter [m], ...
  std::vector<std::int64_t> regions = {};           ///< (element) index into region_names; empty: there is one region
  std::vector<std::string> region_names = {};

  [[nodiscard]] std::size_t nodes() const { return coordinates.size() / 2; }
  [[nodiscard]] std::size_t elements() const { return connectivity.size() / 8; }
};

/// The origin of a run. Values that are not set stay "unknown".
struct Provenance {
  std::string case_kind = "unknown";
  std::string input = {};        ///< the resolved case, TOML
  std::string fingerprint = {};  ///< of the resolved case
  std::string version = "unknown";
  std::string git_hash = "unknown";
  std::string build_compiler = "unknown";  ///< name and version
  std::string build_type = "unknown";      ///< CMake's, such as "Release"
  std::string kokkos = "unknown";          ///< Kokkos version, backends, instruction set
  std::string processor = "unknown";       ///< its name, of the first rank
  std::string lanes = "unknown";           ///< instruction set of the lanes, and why it was chosen
  std::string device = "unknown";          ///< GPU that was chosen for the grains of the first rank, or "none"
  std::string command = "unknown";         ///< command line
  std::string date = "unknown";            ///< start of the run, ISO 8601, UTC
  int threads = 1;                         ///< of the first rank
  int ranks = 1;                           ///< processes
};

enum class FieldLocation {
  node,     ///< (node, components)
  gauss,    ///< (element, 4, components)
  element,  ///< (element, components)
  rve       ///< (rve, components): RVEs that do not sit at Gauss points one to one
};

/// A named quantity, values in row order of the shapes above. Names and units that figures rely on:
/// docs/reference/files.md.
struct Field {
  std::string name = {};
  std::string unit = {};
  FieldLocation location = FieldLocation::node;
  int components = 1;
  std::vector<double> values = {};
};

struct Quantity {
  double value = 0;
  std::string unit = "-";
};
using Quantities = std::map<std::string, Quantity>;  ///< by name

/// Row of the table of increments, and attributes of the increment's own file: the numbers that every increment has,
/// whatever kind of run made it.
struct IncrementInfo {
  int index = 0;              ///< number of the file, counted through all stages
  std::string stage = {};     ///< "column", "gravity", "volume_loss", ...
  int stage_index = 0;        ///< number within the stage
  double load_parameter = 0;  ///< of the stage: load factor of gravity, V_l of the volume loss [-]
  bool converged = false;
  int iterations = 0;
  int evaluations = 0;  ///< calls of the material batch, those of tries that were cut included
  int cuts = 0;         ///< tries that did not converge and were cut
  double residual = 0;  ///< ||R_free|| relative to its reference [-]
  double particle_steps = 0;
  double wall_s = 0;                          ///< [s]
  Quantities extra = {};                      ///< columns that only some kinds of runs have
  std::vector<double> residual_history = {};  ///< relative residual of each iterate [-]
};

/// One column of a named table of run.h5.
struct TableColumn {
  std::string name = {};
  std::string unit = "-";
  std::vector<double> values = {};
};
using Tables = std::map<std::string, std::vector<TableColumn>>;

/// All grains and contacts of one RVE, for pictures and the analysis of its fabric.
struct RveSnapshot {
  std::string name = {};                            ///< name of the group, e.g. "element_0012_point_3"
  std::array<double, 4> cell = {};                  ///< [a_x b_x; a_y b_y] row by row, cell vectors are columns [m]
  double thickness = 0;                             ///< [m]
  std::vector<double> x = {}, y = {}, radius = {};  ///< [m]
  std::vector<double> rotation = {};                ///< since the reference state [rad]
  std::vector<std::int64_t> contact_i = {}, contact_j = {};
  std::vector<double> branch = {};  ///< (contact, 2), from i to j [m]
  std::vector<double> force = {};   ///< (contact, 2), on grain i [N]
};

}  // namespace voussoir::io
