#pragma once
/// What the finite-element side remembers between increments: plain data, all of it needed (and enough) for a
/// checkpoint that resumes with the same bits. The material's own memory is `MaterialBatch::state()`.

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
  std::vector<Tangent> tangent;          ///< of the last matrix of an increment that was committed, n_points [Pa]
  Eigen::VectorXd last_increment;        ///< displacement of the last converged increment, n_dofs [m]
  double last_step = 0;                  ///< load parameter it spanned; 0: there was none
  double start = 0;                      ///< load parameter when the stage began
  double parameter = 0;                  ///< load parameter reached
  double step_limit = 0;                 ///< largest step after cuts; 0: not limited
  double relaxation_factor = 1;  ///< of the last relaxation's end: the next one begins with it (relaxation.hpp) [-]
};

/// A stage begins: displacement and deformation are zero, coordinates those of `coordinates` (usually
/// mesh.coordinates), the initial tangent is the material's committed one.
[[nodiscard]] MeshState begin_stage(const Mesh& mesh, const Coordinates& coordinates, const MaterialBatch& material,
                                    double parameter = 0);

}  // namespace voussoir::fem
