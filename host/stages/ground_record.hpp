#pragma once
/// The ground in the form that result files have (docs/reference/files.md).

#include <vector>

#include "host/case/case.hpp"
#include "host/record/recorder.hpp"
#include "host/stages/ground.hpp"
#include "io/result_data.hpp"

namespace voussoir::host {

enum class BoundaryNames {
  of_files,  ///< those that files of the built-in kinds have: axis is "left", side "right", opening "tunnel"
  of_mesh    ///< the mesh's own
};

/// The mesh with the names of its boundaries and, where it has several, its regions, but without numbers about its
/// geometry.
[[nodiscard]] io::MeshData mesh_data(const fem::Mesh& mesh, BoundaryNames names = BoundaryNames::of_files);

/// The mesh of ground under its own weight, with the numbers that figures need: the height of the surface, the loads
/// and, where the mesh has an opening, the tunnel's diameter and depth.
[[nodiscard]] io::MeshData mesh_data(const fem::Mesh& mesh, const GroundCase& soil);

/// All nodal and Gauss-point fields. At points that have been dug out, all of the latter but the coordinates are NaN.
/// `reactions` are those of fem::Increment::reactions [N/m]; where the vector is
/// empty, the field `reaction` is left out.
[[nodiscard]] std::vector<io::Field> result_fields(const Ground& ground, const Eigen::VectorXd& reactions);

/// Gives the present state of the ground to the recorder, for a result file with the fields and the whole RVEs that
/// `output` asks for.
void record_ground(const Ground& ground, const IncrementReport& increment, const Eigen::VectorXd& reactions,
                   const OutputCase& output, RunRecorder& recorder);

}  // namespace voussoir::host
