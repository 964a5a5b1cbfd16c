#pragma once
/// The ground in the middle of a run: what the stages change, and how it goes into a checkpoint and into result files.

#include <vector>

#include "fem/invariants.hpp"
#include "fem/material_batch.hpp"
#include "fem/mesh.hpp"
#include "fem/mesh_state.hpp"
#include "host/case/case.hpp"
#include "io/checkpoint.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {

struct Ground {
  const Case& input;
  const fem::Mesh& mesh;
  fem::MaterialBatch& material;
  fem::MeshState state;                  ///< of the current stage
  std::vector<fem::PlaneTensor> strain;  ///< sum of the increments' strains since the stage began, n_points [-]
};

/// Displacements and strains start from zero on the original coordinates; the material keeps its state.
void begin_stage(Ground& ground);

/// Everything that the next increment depends on; `restore` throws std::runtime_error on a checkpoint of another mesh.
void save(const Ground& ground, io::Checkpoint& checkpoint);
void restore(Ground& ground, const io::Checkpoint& checkpoint);

/// Nodal and Gauss-point fields of io/FORMAT.md. `reactions` as fem::Increment::reactions [N/m]; empty: not written.
[[nodiscard]] std::vector<io::Field> result_fields(const Ground& ground, const Eigen::VectorXd& reactions);

/// The mesh as result files store it, with the boundary names of io/FORMAT.md.
[[nodiscard]] io::MeshData mesh_data(const fem::Mesh& mesh, const Case& input);

/// Current coordinates for a result file; empty where the mesh has not moved.
[[nodiscard]] std::vector<double> moved_coordinates(const Ground& ground);

}  // namespace voussoir::host
