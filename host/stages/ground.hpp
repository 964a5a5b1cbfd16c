#pragma once
/// The ground during a run: mesh, material and the state that the stages change.

#include <vector>

#include "fem/invariants.hpp"
#include "fem/material_batch.hpp"
#include "fem/mesh.hpp"
#include "fem/mesh_state.hpp"

namespace voussoir::host {

struct Ground {
  const fem::Mesh& mesh;
  fem::MaterialBatch& material;
  fem::MeshState state;                  ///< state of the current stage
  std::vector<fem::PlaneTensor> strain;  ///< sum of the increments' strains since the stage began, n_points [-]
};

/// Sets displacements and strains to zero on the original coordinates; the material keeps its state.
void begin_stage(Ground& ground);

}  // namespace voussoir::host
