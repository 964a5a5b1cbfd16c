#pragma once
/// Results of a run in a folder: increments/NNNN.h5 (each immutable once its name exists), run.h5 (input, provenance,
/// mesh, table of increments, links) and result.xdmf (for ParaView), both replaced by rename. FORMAT.md lists every
/// dataset. A kill at any moment leaves the last finished increment readable; readers never block the writer.

#include <array>
#include <cstdint>
#include <filesystem>
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
  std::map<std::string, double> geometry = {};  ///< further numbers: axis_depth, diameter [m], ...

  [[nodiscard]] std::size_t nodes() const { return coordinates.size() / 2; }
  [[nodiscard]] std::size_t elements() const { return connectivity.size() / 8; }
};

/// Where a run comes from; what no one can know stays "unknown".
struct Provenance {
  std::string case_kind = "unknown";
  std::string input = {};        ///< the resolved case, TOML
  std::string fingerprint = {};  ///< of the resolved case
  std::string version = "unknown";
  std::string git_hash = "unknown";
  std::string build_compiler = "unknown";  ///< name and version
  std::string build_type = "unknown";      ///< CMake's, such as "Release"
  std::string kokkos = "unknown";          ///< Kokkos version, backends, instruction set
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

/// A named quantity, values in row order of the shapes above. Names and units that figures rely on: FORMAT.md.
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

/// Row of the table of increments, and attributes of the increment's own file.
struct IncrementInfo {
  int index = 0;              ///< number of the file, counted through all stages
  std::string stage = {};     ///< "column", "gravity", "volume_loss", ...
  int stage_index = 0;        ///< number within the stage
  double load_parameter = 0;  ///< of the stage: load factor of gravity, V_l of the volume loss [-]
  double volume_loss = 0;     ///< V_l [-]
  bool converged = false;
  int iterations = 0;
  int evaluations = 0;  ///< calls of the material batch, cut tries included
  int cuts = 0;         ///< times the increment was halved
  double residual = 0;  ///< ||R_free|| relative to its reference [-]
  double particle_steps = 0;
  double wall_s = 0;                           ///< [s]
  std::map<std::string, Quantity> extra = {};  ///< further columns
  std::vector<double> residual_history = {};   ///< relative residual of each iterate [-]
};

/// One column of a named table of run.h5.
struct TableColumn {
  std::string name = {};
  std::string unit = "-";
  std::vector<double> values = {};
};
using Tables = std::map<std::string, std::vector<TableColumn>>;

/// One RVE in full, for pictures and fabric analysis.
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

/// Writes the results of one run. All members throw std::runtime_error naming file and reason.
class ResultWriter {
 public:
  /// Starts a new result: earlier results in `folder` are removed, run.h5 and result.xdmf written without increments.
  /// `mesh` may be empty (element tests), then no XDMF file is written.
  [[nodiscard]] static ResultWriter create(const std::filesystem::path& folder, Provenance provenance, MeshData mesh);

  /// Continues after increment `last`: later increments are removed, earlier ones stay and are listed, tables stay.
  [[nodiscard]] static ResultWriter resume(const std::filesystem::path& folder, Provenance provenance, MeshData mesh,
                                           int last);

  /// Writes increment `info.index` (greater than all before), then run.h5 and result.xdmf anew. `coordinates` (node, 2)
  /// [m]: of an updated-Lagrangian mesh, when they differ from the mesh's own. Throws std::invalid_argument for a field
  /// whose size does not fit its location.
  void write(const IncrementInfo& info, const std::vector<Field>& fields,
             const std::vector<RveSnapshot>& snapshots = {}, const std::vector<double>& coordinates = {});

  /// Writes a table of run.h5 that belongs to no increment, such as K0 against stress, in place of an earlier one of
  /// that name. Throws std::invalid_argument for an unusable name, no columns, or columns of different lengths.
  void set_table(const std::string& name, std::vector<TableColumn> columns);

  [[nodiscard]] const std::vector<IncrementInfo>& increments() const { return increments_; }

 private:
  ResultWriter(std::filesystem::path folder, Provenance provenance, MeshData mesh);
  void check(const Field& field) const;
  void write_index() const;

  std::filesystem::path folder_;
  Provenance provenance_;
  MeshData mesh_;
  std::vector<IncrementInfo> increments_;
  Tables tables_;
  std::vector<std::string> grids_;  ///< XDMF grid of each increment
};

/// Path of increment `index` below a result folder.
[[nodiscard]] std::filesystem::path increment_path(const std::filesystem::path& folder, int index);

/// What `voussoir info` prints and resume relies on. Throws std::runtime_error where a file is missing or damaged.
[[nodiscard]] Provenance read_provenance(const std::filesystem::path& run_file);
[[nodiscard]] MeshData read_mesh(const std::filesystem::path& run_file);
[[nodiscard]] std::vector<IncrementInfo> read_increments(const std::filesystem::path& run_file);
[[nodiscard]] Tables read_tables(const std::filesystem::path& run_file);  ///< columns in alphabetical order
[[nodiscard]] std::vector<Field> read_fields(const std::filesystem::path& increment_file);
[[nodiscard]] std::vector<RveSnapshot> read_snapshots(const std::filesystem::path& increment_file);

}  // namespace voussoir::io
