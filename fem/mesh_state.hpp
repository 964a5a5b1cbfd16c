#pragma once
/// The data that the finite-element side remembers between increments. A checkpoint needs all of these plain data, and
/// with `MaterialBatch::state()` they are enough to resume with the same bits.

#include <vector>

#include "fem/material_batch.hpp"
#include "fem/mesh.hpp"

namespace voussoir::fem {

/// How an increment of displacement becomes the gradient F_rel - I that the material receives.
enum class Kinematics {
  updated_lagrangian,  ///< coordinates move at commit; F_rel = I + d Du/d x_n; forces integrated on x_n
  fixed_mesh           ///< coordinates stay; F_rel = I + H F_n^-1, H = d Du/d X; forces integrated on X
};

struct MeshState {
  Eigen::VectorXd displacement;          ///< since the stage began, n_dofs [m]
  Coordinates coordinates;               ///< on which the next increment is integrated [m]
  std::vector<Gradient> deformation;     ///< F_n - I since the stage began, n_points [-]
  std::vector<Tangent> initial_tangent;  ///< of the material when the stage began, n_points [Pa]
  std::vector<Tangent> tangent;    ///< from which the last matrix was made in a committed increment, n_points [Pa]
  Eigen::VectorXd last_increment;  ///< displacement of the last converged increment, n_dofs [m]
  double last_step = 0;            ///< load parameter that this increment spanned; 0 where there was none
  double start = 0;                ///< load parameter when the stage began
  double parameter = 0;            ///< load parameter reached
  double step_limit = 0;           ///< largest step after cuts; 0 where steps are not limited
  double relaxation_factor = 1;    ///< at the end of the last relaxation; the next one begins with it (relaxation.hpp)
                                   ///< [-]
};

/// The state at the start of a stage: displacement and deformation are zero, the coordinates are `coordinates` (usually
/// mesh.coordinates), and the initial tangent is that of the material's committed state.
[[nodiscard]] MeshState begin_stage(const Mesh& mesh, const Coordinates& coordinates, const MaterialBatch& material,
                                    double parameter = 0);

}  // namespace voussoir::fem
