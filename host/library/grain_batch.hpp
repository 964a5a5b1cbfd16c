#pragma once
/// RVEs behind plain arrays, for bindings to other languages: Python and C call this one class. A GrainBatch adds to
/// the pool what a stranger's loop needs: points that answer as mirror images, states of single points, answers that
/// are NaN where a point has failed, and a refusal to commit what is not fit for it. It contains no physics of its own.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "host/material/rve_pool.hpp"
#include "io/packing_file.hpp"
#include "io/result_data.hpp"

namespace voussoir::library {

/// A packing and the soil that its grains are made of.
struct Grains {
  host::PackedRve rve;
  host::SoilCase soil;
};

/// The grains of a packing file. The soil is the one that the file says it was made with.
/// @throws std::invalid_argument where the file is no complete packing of this program, or says no soil
[[nodiscard]] Grains grains_of(const io::Packing& file);

/// The packing of these grains as a file keeps it. @param recipe of the packing; empty: the state has none
[[nodiscard]] io::Packing file_of(const Grains& grains, const std::string& recipe = "");

/// Report of one point, with a fixed layout. The meaning is that of kernels::RveReport.
struct PointReport {
  std::int32_t status = 0;    ///< kernels::RveStatus
  std::int32_t steps = 0;     ///< executed, hold included
  std::int32_t contacts = 0;  ///< number of contacts that carry force
  std::int32_t reserved = 0;
  double unbalanced = 0;       ///< unbalanced ratio at the end [-]
  double inertial_number = 0;  ///< of the strain phase [-]
  double largest_overlap = 0;  ///< over r_i + r_j [-]
  double mean_overlap = 0;     ///< the same, mean over the contacts [-]
  double cell_area = 0;        ///< at the end [m^2]
};

/// Where the answers of all points go, row by row.
struct AnswerArrays {
  std::span<double> stress;        ///< (n, 2, 2), or (n, 3) as (xx, yy, xy): Cauchy stress, tension positive [Pa]
  std::span<double> tangent;       ///< (n, 3, 3) d stress / d strain in (xx, yy, gamma_xy) [Pa]; empty: not wanted
  std::span<PointReport> reports;  ///< (n)
};

/// @param gradients (n, 2, 2) @throws std::invalid_argument where a number is not finite, with the first such RVE
void require_finite(std::span<const double> gradients);

class GrainBatch {
 public:
  /// One RVE at each point. @param packing_of (n) index into `packings`; @param mirrored (n), or empty: none is
  /// @throws std::invalid_argument where there is no packing or no point, an index is wrong, or a packing cannot start
  GrainBatch(std::vector<Grains> packings, std::vector<int> packing_of, const host::PoolOptions& options,
             std::vector<bool> mirrored);

  [[nodiscard]] std::size_t size() const { return pool_->size(); }
  [[nodiscard]] const std::vector<int>& packing_of() const { return packing_of_; }
  [[nodiscard]] std::string device_sentence() const { return pool_->device_sentence(); }
  void set_pause(host::Pause pause, host::Watched watched = {}) {
    pool_->set_pause(std::move(pause), std::move(watched));
  }

  /// Answers to displacement gradients (n, 2, 2) that count from the committed state [-]. The numbers of steps follow
  /// the first evaluation of an increment and stay until `commit` or `begin_increment`. A point that has failed answers
  /// with NaN.
  /// @throws std::invalid_argument where a gradient is not finite, or all gradients are within 0.1 of the identity
  /// matrix, as F is; what a pause throws
  fem::BatchReport evaluate(std::span<const double> f_minus_i, const AnswerArrays& to);

  /// Wall time of the last evaluation without what this class adds to the pool's own [s].
  [[nodiscard]] double engine_seconds() const { return engine_seconds_; }

  /// Makes the state of the last evaluation the committed one, and begins an increment.
  /// @throws std::logic_error where there is no evaluation since the last commit, or the last one was not usable or did
  /// not end
  void commit();
  [[nodiscard]] bool may_commit() const { return trial_ == Trial::usable; }
  /// The last evaluation cannot be committed any more.
  void forget_trial() { trial_ = Trial::unfinished; }
  /// The next evaluation chooses the numbers of steps anew.
  void begin_increment();
  /// The answers of the committed state. The tangent is the one that the committed evaluation has found.
  void committed(const AnswerArrays& to) const;

  /// The committed state of these points as bytes; of all points, in their order, those of fem::MaterialBatch::state.
  /// @throws std::out_of_range where there is no such point
  [[nodiscard]] std::vector<std::byte> state(std::span<const std::size_t> points) const;
  /// The state of all points, which its owner writes piece by piece.
  [[nodiscard]] std::shared_ptr<const fem::HeldState> hold() const { return pool_->hold(); }
  /// Gives a state to these points, which must have the packings of the points that it was taken from; begins an
  /// increment. @throws std::runtime_error where the bytes are no state of such points, std::invalid_argument where a
  /// point occurs twice; nothing has changed then
  void set_state(std::span<const std::byte> bytes, std::span<const std::size_t> points);

  [[nodiscard]] std::vector<fem::PointField> fields() const { return batch_->fields(); }
  [[nodiscard]] std::vector<double> void_ratios() const;            ///< of the committed state (n) [-]
  [[nodiscard]] io::RveSnapshot snapshot(std::size_t point) const;  ///< mirrored where the point is
  [[nodiscard]] io::Packing packing(std::size_t point) const;       ///< its grains, which are never mirrored

 private:
  enum class Trial { none, unusable, unfinished, usable };

  void take_gradients(std::span<const double> f_minus_i);
  void give(const AnswerArrays& to, std::span<const kernels::RveReport> reports) const;
  void check(std::span<const std::size_t> points) const;
  [[nodiscard]] std::vector<int> packings_of(std::span<const std::size_t> points) const;

  std::vector<host::SoilCase> soils_;  ///< (packing)
  std::vector<std::int64_t> seeds_;    ///< (packing)
  std::vector<int> packing_of_;        ///< (point)
  host::RvePool* pool_ = nullptr;      ///< owned by batch_
  std::unique_ptr<fem::MaterialBatch> batch_;
  bool increment_begins_ = true;
  Trial trial_ = Trial::none;
  std::string fault_;  ///< of an unusable trial
  double engine_seconds_ = 0;
  std::vector<fem::Gradient> gradients_;
  mutable std::vector<fem::Stress> stresses_;
};

/// RVEs as a case describes them by [engine], the kind of tangent and output.microstructure.
/// @param input an accepted case (accepted_case.hpp) @param mix its packings, mix_of(input, n)
[[nodiscard]] std::unique_ptr<GrainBatch> make_batch(const host::Case& input, host::PackingMix mix,
                                                     std::vector<bool> mirrored = {});

}  // namespace voussoir::library
