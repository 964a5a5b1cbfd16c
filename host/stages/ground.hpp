#pragma once
/// The ground during a run: mesh, material and the state that the stages change.

#include <vector>

#include "fem/invariants.hpp"
#include "fem/material_batch.hpp"
#include "fem/mesh.hpp"
#include "fem/mesh_state.hpp"

namespace voussoir::host {

/// What stages that moved the mesh have left behind where others went on from there; all empty where none has.
struct EarlierStages {
  Eigen::VectorXd displacement = {};          ///< until the present stage began, n_dofs [m]
  std::vector<fem::PlaneTensor> strain = {};  ///< the same, n_points [-]
  fem::Coordinates coordinates = {};          ///< when the present stage began [m]
};

struct Ground {
  const fem::Mesh& mesh;
  fem::MaterialBatch& material;
  fem::MeshState state;                       ///< state of the current stage
  std::vector<fem::PlaneTensor> strain = {};  ///< sum of the increments' strains since the stage began, n_points [-]
  EarlierStages earlier = {};

  /// The coordinates when the present stage began.
  [[nodiscard]] const fem::Coordinates& stage_coordinates() const {
    return earlier.coordinates.cols() > 0 ? earlier.coordinates : mesh.coordinates;
  }
  /// The displacement since the mesh was as drawn, but for stages on a fixed mesh, n_dofs [m].
  [[nodiscard]] Eigen::VectorXd total_displacement() const;
  /// The sum of strains, counted as displacements are, n_points [-].
  [[nodiscard]] std::vector<fem::PlaneTensor> total_strain() const;
};

/// Sets displacements and strains to zero on the original coordinates; the material keeps its state.
void begin_stage(Ground& ground);

/// Begins a stage on the coordinates that the stage before has left. Displacements and strains of a stage that moved
/// the mesh stay in the totals.
void go_on_to_next_stage(Ground& ground, fem::Kinematics before);

}  // namespace voussoir::host
