#pragma once
/// Results of a run in a folder: increments/NNNN.h5 (each immutable once its name exists), run.h5 (input, provenance,
/// mesh, table of increments, links) and result.xdmf (for ParaView), both replaced by rename. docs/reference/files.md
/// lists every dataset. A kill at any moment leaves the last finished increment readable; readers never block the
/// writer.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/result_data.hpp"

namespace voussoir::io {

/// Writes the results of one run. All members throw std::runtime_error naming file and reason.
class ResultWriter {
 public:
  /// Starts a new result: removes earlier results in `folder`, which must be there, then writes run.h5 and result.xdmf
  /// without increments.
  /// Element tests have an empty `mesh`; no XDMF file is written for them.
  [[nodiscard]] static ResultWriter create(const std::filesystem::path& folder, Provenance provenance, MeshData mesh);

  /// Continues after increment `last`: removes later increments; earlier ones and all tables stay.
  [[nodiscard]] static ResultWriter resume(const std::filesystem::path& folder, Provenance provenance, MeshData mesh,
                                           int last);

  /// Writes increment `info.index` (greater than all before), then run.h5 and result.xdmf anew. `coordinates` (node, 2)
  /// [m] are given for an updated-Lagrangian mesh, when they differ from the mesh's own. Throws std::invalid_argument
  /// for a field whose size does not fit its location.
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

/// Reads the parts of a result back. All of these throw std::runtime_error where a file is missing or damaged.
[[nodiscard]] Provenance read_provenance(const std::filesystem::path& run_file);
[[nodiscard]] MeshData read_mesh(const std::filesystem::path& run_file);
[[nodiscard]] std::vector<IncrementInfo> read_increments(const std::filesystem::path& run_file);
[[nodiscard]] Tables read_tables(const std::filesystem::path& run_file);  ///< columns in alphabetical order
[[nodiscard]] std::vector<Field> read_fields(const std::filesystem::path& increment_file);
/// One field of an increment; nothing where the increment was written without it.
[[nodiscard]] std::optional<Field> find_field(const std::filesystem::path& increment_file, FieldLocation location,
                                              const std::string& name);
[[nodiscard]] std::vector<RveSnapshot> read_snapshots(const std::filesystem::path& increment_file);

}  // namespace voussoir::io
