#pragma once
/// The HDF5 file of one increment, and its XDMF grid. docs/reference/files.md describes the contents. result_file.hpp
/// is the interface for other folders.

#include "io/result_file.hpp"

namespace voussoir::io {

class Hdf5File;

/// Calls visit(name, unit, member) for the numbers that every increment has. Attributes and columns are made from this
/// list alone.
template <class Info, class Visit>
void for_each_number(Info& info, Visit&& visit) {
  visit("index", "-", info.index);
  visit("stage_index", "-", info.stage_index);
  visit("load_parameter", "-", info.load_parameter);
  visit("converged", "-", info.converged);
  visit("iterations", "-", info.iterations);
  visit("evaluations", "-", info.evaluations);
  visit("cuts", "-", info.cuts);
  visit("residual", "-", info.residual);
  visit("particle_steps", "-", info.particle_steps);
  visit("wall_s", "s", info.wall_s);
}

/// Writes and publishes an increment's file, with the kind and the fingerprint of the run that it belongs to.
void write_increment_file(const std::filesystem::path& path, const Provenance& run, const MeshData& mesh,
                          const IncrementInfo& info, const std::vector<Field>& fields,
                          const std::vector<RveSnapshot>& snapshots, const std::vector<double>& coordinates);

/// True for a readable file of an increment, of whichever run.
[[nodiscard]] bool is_increment_file(const std::filesystem::path& path);

/// Reads the numbers of an increment, and all of its file to see whether it is whole. Throws std::runtime_error where
/// the file is damaged, is the file of another run, or has the name of another index.
/// Files of older versions do not say their run.
[[nodiscard]] IncrementInfo read_increment_info(const std::filesystem::path& path, const Provenance& run);

/// The group of an increment's file in which fields of this location stand.
[[nodiscard]] const char* group_of(FieldLocation location);

/// The shape of a field's dataset.
[[nodiscard]] std::vector<std::size_t> shape_of(const Field& field);

/// The <Grid> element of one increment; `path` is the increment's file in its folder below the XDMF file.
[[nodiscard]] std::string xdmf_grid(const std::filesystem::path& path, const MeshData& mesh, const IncrementInfo& info);

/// The whole XDMF file around the grids.
[[nodiscard]] std::string xdmf_document(const std::vector<std::string>& grids);

/// Numbers of the increments that exist in a result folder, ascending.
[[nodiscard]] std::vector<int> list_increments(const std::filesystem::path& folder);

}  // namespace voussoir::io
