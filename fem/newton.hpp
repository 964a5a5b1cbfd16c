#pragma once
/// Brings one load increment to equilibrium: Newton's method with Anderson acceleration, on a tangent that is only
/// roughly right.
///
/// Converged means, at the last evaluated iterate, all of
///   |R_free| <= tolerance * max(|f_ext|, |reactions|, reference_force) + noise floor [N/m],
///   |du| <= displacement_tolerance * |Du| + noise floor [m], or |du| <= length_tolerance,
/// where R = f_ext - f_int, norms are 2-norms, du = K^-1 R is the correction that would follow and is not applied, and
/// Du is the increment. The noise floors are noise_factor times the effect on R and on K^-1 R of stress errors that are
/// independent from point to point and as large as BatchReport::stress_noise.

#include <algorithm>
#include <functional>
#include <string>

#include "fem/assembly.hpp"
#include "fem/increment.hpp"
#include "fem/mesh_state.hpp"
#include "fem/part_times.hpp"

namespace voussoir::fem {

struct NewtonOptions {
  double tolerance = 1e-3;               ///< on the residual force [-]
  double displacement_tolerance = 1e-2;  ///< on the correction [-]
  double length_tolerance = 1e-9;        ///< a shorter correction counts as none (2-norm over all dofs) [m]
  int max_iterations = 40;
  /// Share of the stage's initial tangent that is added to the tangent; it must be positive where tangents may vanish
  /// [-].
  double initial_tangent_share = 0.02;
  /// Number of iterates for which a matrix is used. The first iterate has a new matrix unless the load keeps the old
  /// one.
  int refactor_every = 1;
  int anderson_depth = 5;           ///< 0: plain Newton
  double anderson_condition = 1e6;  ///< largest condition of the least squares; older pairs are dropped to keep to it
                                    ///< [-]
  double growth_limit = 3.0;  ///< a residual that grows by more than this halves the step and restarts Anderson [-]
  int max_halvings = 2;       ///< halvings of one correction at the most
  /// Largest noise floor of the residual, over the tolerance that it is added to: noise must not pass for convergence.
  double noise_limit = 2.0;
  /// Factor on both noise floors, 0 for none. At 1 an iterate at the solution would fail every other time by chance.
  double noise_factor = 1.5;
};

enum class NewtonStatus {
  converged,
  max_iterations,
  near,             ///< not converged, but within IncrementLoad::near_residual: a relaxation shall go on from here
  material_failed,  ///< BatchReport::usable was false at every trial step
  not_positive_definite,  ///< even with a hundred times the initial tangent's share
  inverted_element,       ///< det J or det F_rel not positive at every trial step
  not_finite              ///< a stress, force or displacement is not a number
};
[[nodiscard]] const char* to_string(NewtonStatus status);

struct NewtonReport {
  NewtonStatus status = NewtonStatus::max_iterations;
  int iterations = 0;   ///< iterates that were reached; the last one is the solution where it converged
  int evaluations = 0;  ///< calls of MaterialBatch::evaluate
  int factorisations = 0;
  std::vector<double> residual_history;    ///< |R_free| of each iterate [N/m]
  std::vector<double> correction_history;  ///< |K^-1 R| of each iterate [m]
  double residual = 0;                     ///< |R_free| at the end [N/m]
  double residual_bound = 0;               ///< bound of the residual, its noise floor included [N/m]
  double noise_floor = 0;                  ///< the part of residual_bound that is noise [N/m]
  double unsettled_force = 0;              ///< effect of BatchReport::unsettled_stress on |R| [N/m]
  double correction_bound = 0;             ///< bound of the last correction, its noise floor included [m]
  double external_norm = 0;                ///< |f_ext| [N/m]
  double reaction_norm = 0;                ///< |reactions| [N/m]
  double reference_force = 0;              ///< IncrementLoad::reference_force [N/m]
  double increment_norm = 0;               ///< |Du| [m]
  double largest_nodal_ratio = 0;          ///< max over nodes of |R_i| / (sum of |element forces| + |f_ext|) there [-]
  Point worst_place = Point::Zero();       ///< of the node with the largest |R_i| [m]
  int relaxations = 0;                     ///< substeps of a relaxation (relaxation.hpp); 0 where there was none
  double viscous_work = 0;                 ///< dissipated by these substeps [J/m]
  std::size_t work = 0;                    ///< sum of BatchReport::work
  std::size_t lane_steps = 0;              ///< sum of BatchReport::lane_steps
  PartTimes times;                         ///< wall time of the parts
  /// The report of the last evaluation, except that `deferral_error` is the largest of all evaluations that the
  /// increment has committed: each substep of a relaxation commits one.
  BatchReport material;

  /// The force that the tolerance is relative to [N/m].
  [[nodiscard]] double reference() const { return std::max({external_norm, reaction_norm, reference_force}); }
};

/// An iterate when it has just been evaluated, for a display of progress; `bound` is NewtonReport::residual_bound.
struct Iterate {
  int iteration;
  double residual;
  double bound;
  const BatchReport& material;
};

class NewtonSolver {
 public:
  /// Keeps references to the mesh and the material, which must outlive the solver. Throws std::invalid_argument if
  /// their sizes differ or an option is out of range.
  NewtonSolver(const Mesh& mesh, MaterialBatch& material, Kinematics kinematics, const NewtonOptions& options);

  /// Finds the equilibrium; neither `state` nor the material's committed state changes.
  [[nodiscard]] NewtonReport solve_increment(const MeshState& state, const IncrementLoad& load, Increment& increment);

  /// Takes the increment over into the state and commits the material. The material's last evaluation must be the one
  /// at this increment, which has converged or is a substep of a relaxation.
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

}  // namespace voussoir::fem
