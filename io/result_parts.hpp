#pragma once
/// The parts that run.h5 and ensemble.h5 have in common: where a result comes from, and its mesh.

#include "io/hdf5.hpp"
#include "io/result_data.hpp"

namespace voussoir::io {

/// Writes /input and the attributes of /provenance.
void write_provenance(Hdf5File& file, const Provenance& provenance);
[[nodiscard]] Provenance read_provenance(const Hdf5File& file);

/// Writes /mesh.
void write_mesh(Hdf5File& file, const MeshData& mesh);

}  // namespace voussoir::io
