#pragma once
/// The interface between the mesh and its material. It treats all Gauss points at once.
///
/// `evaluate` always starts from the committed state, so a Newton iterate or a cut step needs no rollback.
/// Voigt order is (xx, yy, xy); tension is positive; strains in tangents are engineering shears (gamma_xy).

#include <Eigen/Dense>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace voussoir::fem {

using Gradient = Eigen::Matrix2d;  ///< F_rel - I of the increment [-], F_rel maps committed to trial configuration
using Stress = Eigen::Vector3d;    ///< Cauchy stress (xx, yy, xy) [Pa]
using Tangent = Eigen::Matrix3d;   ///< d stress / d strain [Pa], symmetric, conjugate to (xx, yy, gamma_xy)

/// One report for the whole batch; `fields()` tells of single points.
struct BatchReport {
  bool usable = true;   ///< false where at least one point failed: the increment must be cut
  std::string message;  ///< what failed and where; empty where usable
  /// Rms uncertainty of the returned stresses, from the points' own reports [Pa]. It leaves out points at `step_limit`,
  /// which are not at rest.
  double stress_noise = 0;
  std::size_t work = 0;        ///< particle-steps spent by this call (0 for a continuum law)
  std::size_t lane_steps = 0;  ///< the same, with the lanes counted that stood idle meanwhile
  double tangent_time = 0;     ///< the part of this call's wall time that the tangents took [s]
  std::size_t open = 0;        ///< points without any contact (stress 0)
  std::size_t step_limit = 0;  ///< points whose hold ended at its cap
  /// Rms over all points of the stress error that points at `step_limit` may have: each its own pressure [Pa].
  double unsettled_stress = 0;
  std::size_t out_of_range = 0;  ///< points beyond what their law is good for; their stresses count all the same
  std::optional<double> mean_overlap = {};  ///< of grains: the largest mean overlap of a point [-]
  std::size_t deferred = 0;                 ///< points that answered by their last tangent
  /// Largest error of such answers, earlier ones, that the grains have shown in this call, over the pressure [-].
  double deferral_error = 0;
  std::size_t slowest = 0;  ///< the point that took most steps
  int slowest_steps = 0;    ///< its steps; 0 for a continuum law
};

/// A named quantity at every point, for result files: values[point * components + k].
struct PointField {
  std::string name;
  std::string unit;
  int components = 1;
  std::vector<double> values;
};

/// A committed state that stays what it is while its batch goes on. Another thread may read it.
class HeldState {
 public:
  using Sink = std::function<void(std::span<const std::byte>)>;

  virtual ~HeldState() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;  ///< number of bytes that `write` gives
  /// Gives the bytes of MaterialBatch::state() of that moment to `sink`, piece by piece.
  virtual void write(const Sink& sink) const = 0;
};

class MaterialBatch {
 public:
  virtual ~MaterialBatch() = default;

  [[nodiscard]] virtual std::size_t size() const = 0;

  /// Begins a new increment. The step counts of RVEs follow the first `evaluate` after this call and stay frozen until
  /// the next call, so that the stress is a fixed function of the gradient within an increment. Only a gradient that
  /// asks for more than twice the frozen steps gets more.
  virtual void begin_increment() = 0;

  /// Computes stress and tangent after the gradients, which count from the committed state. All spans have `size()`
  /// entries; with an empty `tangent` no tangents are computed, which saves their cost.
  virtual BatchReport evaluate(std::span<const Gradient> gradients, std::span<Stress> stress,
                               std::span<Tangent> tangent) = 0;

  /// Makes the state of the last `evaluate` the committed one.
  virtual void commit() = 0;

  /// Gives the stress of the committed state, and the tangent that its evaluation computed or would have had at no
  /// further cost; with an empty `tangent` the stress alone.
  virtual void committed(std::span<Stress> stress, std::span<Tangent> tangent) const = 0;

  /// Further quantities of the committed state (void ratio, coordination, status, ...). They are computed in this call
  /// and nowhere else.
  [[nodiscard]] virtual std::vector<PointField> fields() const = 0;

  /// The committed state as opaque bytes for a checkpoint; `set_state` throws std::runtime_error on bytes of another
  /// batch.
  [[nodiscard]] virtual std::vector<std::byte> state() const = 0;
  virtual void set_state(std::span<const std::byte> bytes) = 0;

  /// Takes points out of the batch that have been dug out. From now on they answer with zero stress and zero tangent,
  /// they cost nothing, they count in no report, and their fields are NaN. That is no part of the state: it outlasts
  /// `set_state` and `return_to`, and a new batch that takes over a state has to be told again. A point may be named
  /// several times. Throws std::out_of_range where a point does not exist, and std::logic_error where the batch is of a
  /// kind that cannot be dug out.
  virtual void retire(std::span<const std::size_t> points);

  /// Holds the committed state, to go back to it or to write it to a file later. Here the state's bytes are copied; a
  /// batch whose states are large holds them without a copy.
  [[nodiscard]] virtual std::shared_ptr<const HeldState> hold();
  /// Makes a state that this batch has held the committed one again.
  virtual void return_to(const HeldState& held);
};

}  // namespace voussoir::fem
