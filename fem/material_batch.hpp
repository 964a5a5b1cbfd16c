#pragma once
/// The one door between the mesh and its material: all Gauss points at once.
///
/// `evaluate` always starts from the committed state, so a Newton iterate or a cut step needs no rollback.
/// Voigt order is (xx, yy, xy); tension is positive; strains in tangents are engineering shears (gamma_xy).

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace voussoir::fem {

using Gradient = Eigen::Matrix2d;  ///< F_rel - I of the increment [-], F_rel maps committed to trial configuration
using Stress = Eigen::Vector3d;    ///< Cauchy stress (xx, yy, xy) [Pa]
using Tangent = Eigen::Matrix3d;   ///< d stress / d strain [Pa], symmetric, conjugate to (xx, yy, gamma_xy)

/// One answer for the whole batch; single points speak through `fields()`.
struct BatchReport {
  bool usable = true;       ///< false: at least one point failed, the increment must be cut
  std::string message;      ///< what failed and where, empty when usable
  double stress_noise = 0;  ///< rms uncertainty of the returned stresses [Pa], from the points' own reports; of points
                            ///< at `step_limit`, which are not at rest, it says nothing
  std::size_t work = 0;     ///< particle-steps spent by this call (0 for a continuum law)
  std::size_t lane_steps = 0;   ///< the same with idle SIMD lanes counted: work / lane_steps is the share that worked
  std::size_t open = 0;         ///< points without any contact (stress 0)
  std::size_t step_limit = 0;   ///< points whose hold ended at its cap
  double unsettled_stress = 0;  ///< rms over all points of what those may be off by, each by its own pressure [Pa]
  std::size_t deferred = 0;     ///< points that answered by their last tangent
  double deferral_error = 0;    ///< largest error of earlier such answers that this call has shown, over the points'
                                ///< pressures [-]
  std::size_t slowest = 0;      ///< the point that took most steps
  int slowest_steps = 0;        ///< its steps; 0 for a continuum law
};

/// A named quantity at every point, for result files: values[point * components + k].
struct PointField {
  std::string name;
  std::string unit;
  int components = 1;
  std::vector<double> values;
};

class MaterialBatch {
 public:
  virtual ~MaterialBatch() = default;

  [[nodiscard]] virtual std::size_t size() const = 0;

  /// Forget what was fixed for the last increment (step counts of RVEs follow the first `evaluate` after this call and
  /// stay frozen until the next, so that stress is a fixed function of the gradient within an increment; only a
  /// gradient that asks for more than twice the frozen steps gets them).
  virtual void begin_increment() = 0;

  /// Stress and tangent at committed state + gradients. All spans have `size()` entries; an empty `tangent` asks for
  /// none, and what one costs is saved.
  virtual BatchReport evaluate(std::span<const Gradient> gradients, std::span<Stress> stress,
                               std::span<Tangent> tangent) = 0;

  /// The state of the last `evaluate` becomes the committed one.
  virtual void commit() = 0;

  /// Stress of the committed state, and the tangent that its evaluation gave or would have given for nothing; an empty
  /// `tangent` asks for none.
  virtual void committed(std::span<Stress> stress, std::span<Tangent> tangent) const = 0;

  /// Further quantities of the committed state (void ratio, coordination, status, ...); what is not needed is not
  /// computed.
  [[nodiscard]] virtual std::vector<PointField> fields() const = 0;

  /// The committed state as opaque bytes for a checkpoint; `set_state` throws std::runtime_error on bytes of another
  /// batch.
  [[nodiscard]] virtual std::vector<std::byte> state() const = 0;
  virtual void set_state(std::span<const std::byte> bytes) = 0;
};

}  // namespace voussoir::fem
