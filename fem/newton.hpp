#pragma once
/// One load increment to equilibrium: Newton with Anderson acceleration on a tangent that is only roughly right.
///
/// Converged means, at the last evaluated iterate, all of
///   |R_free| <= tolerance * max(|f_ext|, |reactions|, reference_force) + noise floor [N/m],
///   |du| <= displacement_tolerance * |Du| + noise floor [m], or |du| <= length_tolerance,
/// with R = f_ext - f_int, 2-norms, du = K^-1 R the correction that would follow (it is not applied), Du the increment.
/// The floors are noise_factor times what independent stress errors of BatchReport::stress_noise do to R and to K^-1 R.

#include <algorithm>
#include <functional>
#include <string>

#include "fem/assembly.hpp"
#include "fem/boundary.hpp"
#include "fem/mesh_state.hpp"
#include "fem/part_times.hpp"

namespace voussoir::fem {

struct NewtonOptions {
  double tolerance = 1e-3;               ///< on the residual force [-]
  double displacement_tolerance = 1e-2;  ///< on the correction [-]
  double length_tolerance = 1e-9;        ///< a correction below it counts as none (2-norm over all dofs) [m]
  int max_iterations = 40;
  double initial_tangent_share = 0.02;  ///< times the stage's initial tangent is added to the tangent; > 0 where it may
                                        ///< vanish
  int refactor_every = 1;  ///< iterates between new tangents; the first iterate has a new one unless the load keeps the
                           ///< matrix
  int anderson_depth = 5;  ///< 0: plain Newton
  double anderson_condition = 1e6;  ///< limit on the condition of the least squares; older pairs are dropped beyond
  double growth_limit = 3.0;        ///< a residual grown by more than this halves the step and restarts Anderson
  int max_halvings = 2;             ///< of one correction
  double noise_limit = 2.0;         ///< largest force floor over the tolerance it is added to: noise is no convergence
  double noise_factor = 1.5;        ///< on both noise floors; 0: none. At 1 only every other iterate would pass by luck
};

enum class NewtonStatus {
  converged,
  max_iterations,
  near,                   ///< not converged, but within IncrementLoad::near_residual: to be relaxed from there
  material_failed,        ///< BatchReport::usable was false at every trial step
  not_positive_definite,  ///< even with a hundred times the initial tangent's share
  inverted_element,       ///< det J or det F_rel not positive at every trial step
  not_finite              ///< a stress, force or displacement is not a number
};
[[nodiscard]] const char* to_string(NewtonStatus status);

struct NewtonReport {
  NewtonStatus status = NewtonStatus::max_iterations;
  int iterations = 0;   ///< iterates reached (the last is the converged one)
  int evaluations = 0;  ///< calls of MaterialBatch::evaluate
  int factorisations = 0;
  std::vector<double> residual_history;    ///< |R_free| of each iterate [N/m]
  std::vector<double> correction_history;  ///< |K^-1 R| of each iterate [m]
  double residual = 0;                     ///< |R_free| at the end [N/m]
  double residual_bound = 0;               ///< what it is compared with [N/m], the noise floor included
  double noise_floor = 0;                  ///< its part of residual_bound [N/m]
  double unsettled_force = 0;              ///< on |R|, of BatchReport::unsettled_stress [N/m]
  double correction_bound = 0;             ///< what the last correction is compared with [m], its noise floor included
  double external_norm = 0;                ///< |f_ext| [N/m]
  double reaction_norm = 0;                ///< |reactions| [N/m]
  double reference_force = 0;              ///< of the load [N/m]
  double increment_norm = 0;               ///< |Du| [m]
  double largest_nodal_ratio = 0;          ///< max over nodes of |R_i| / (sum of |element forces| + |f_ext|) there [-]
  int relaxations = 0;                     ///< substeps of relaxation.hpp; 0: the increment needed none
  double viscous_work = 0;                 ///< dissipated by them [J/m]
  std::size_t work = 0;                    ///< sum of BatchReport::work
  std::size_t lane_steps = 0;              ///< sum of BatchReport::lane_steps
  PartTimes times;                         ///< where the wall time went
  BatchReport material;                    ///< of the last evaluation; its deferral_error: of all that were committed

  /// What the tolerance is relative to [N/m].
  [[nodiscard]] double reference() const { return std::max({external_norm, reaction_norm, reference_force}); }
};

/// What an increment is asked for.
struct IncrementLoad {
  Eigen::VectorXd external_force;   ///< at the end of the increment, n_dofs [N/m]
  Constraints prescribed;           ///< displacement increments [m]
  double predictor_ratio = 0;       ///< first iterate: ratio * last increment; 0: elastic from the committed state
  double reference_force = 0;       ///< see the convergence definition, e.g. the norm of a stage's final load [N/m]
  Eigen::VectorXd first_step = {};  ///< the first iterate, n_dofs [m]; empty: as predictor_ratio says
  double moved = 0;                 ///< norm of a displacement that Du is a further part of (relaxation.hpp) [m]
  int max_iterations = 0;           ///< 0: NewtonOptions::max_iterations
  bool keep_matrix = false;         ///< K stays that of the last call: no tangents are asked for
  double near_residual = 0;         ///< over the reference of the tolerance: ends the iterates as `near` [-]; 0: never
  bool settle = false;  ///< points at their step limit must not matter: unsettled_force within the tolerance, or not
                        ///< converged
  bool leave_best = false;  ///< max_iterations, near: the material's last evaluation is at the best iterate
};

/// The last iterate, or with IncrementLoad::leave_best the best one.
struct Increment {
  Eigen::VectorXd displacement;     ///< Du, n_dofs [m]
  std::vector<Gradient> gradients;  ///< F_rel - I, n_points [-]
  std::vector<Stress> stress;       ///< n_points [Pa]
  std::vector<Tangent> tangent;     ///< those of K, n_points; empty: of an increment that kept the matrix [Pa]
  Eigen::VectorXd external_force;   ///< n_dofs [N/m]
  Eigen::VectorXd reactions;  ///< f_int - f_ext at constrained dofs, zero elsewhere; of the support on the soil [N/m]
  Eigen::VectorXd residual;   ///< f_ext - f_int at free dofs, zero elsewhere, n_dofs [N/m]
  GaussPoints points;         ///< the geometry of the integration
  Eigen::VectorXd last_part;  ///< displacement since that geometry: Du, or the last substep's where it was relaxed [m]
};

/// An iterate as it happens, for progress; `bound` as NewtonReport::residual_bound.
struct Iterate {
  int iteration;
  double residual;
  double bound;
  const BatchReport& material;
};

class NewtonSolver {
 public:
  /// Keeps references to the mesh and the material. Throws std::invalid_argument if their sizes differ or an option is
  /// out of range.
  NewtonSolver(const Mesh& mesh, MaterialBatch& material, Kinematics kinematics, const NewtonOptions& options);

  /// Finds the equilibrium; neither `state` nor the material's committed state changes.
  [[nodiscard]] NewtonReport solve_increment(const MeshState& state, const IncrementLoad& load, Increment& increment);

  /// Takes the increment over into the state and commits the material, whose last evaluation it must be: a converged
  /// one, or a substep of relaxation.hpp.
  void commit(MeshState& state, Increment& increment);

  std::function<void(const Iterate&)> on_iterate;  ///< may be empty

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] MaterialBatch& material() { return material_; }
  [[nodiscard]] SparseSolver& linear_solver() { return solver_; }  ///< with the matrix of the last iterate

 private:
  struct Workspace;
  const Mesh& mesh_;
  MaterialBatch& material_;
  Kinematics kinematics_;
  NewtonOptions options_;
  StiffnessAssembler assembler_;
  SparseSolver solver_;
};

/// Force on the residual's norm of independent stress errors of `stress_noise` rms [Pa] at every Gauss point:
/// |R|^2 = noise^2 * sum over points of volume^2 * sum over free dofs of |grad N|^2 [N/m].
[[nodiscard]] double noise_force(const Mesh& mesh, const GaussPoints& points, const std::vector<char>& constrained,
                                 double stress_noise);

/// Nodal forces of one fixed draw of such errors, +-1 Pa each (zero at constrained dofs) [N/m]: |K^-1 f| estimates what
/// the noise does to a correction, which its expectation would cost one solution for every point to know.
[[nodiscard]] Eigen::VectorXd unit_noise_sample(const Mesh& mesh, const GaussPoints& points,
                                                const std::vector<char>& constrained);

}  // namespace voussoir::fem
