#pragma once
/// Mirror images of one packing. One packing cloned to all points biases tau_xy at all of them, and where the bias
/// grows with depth, equilibrium makes sigma_xx vary across the whole ground. Therefore every second Gauss point of an
/// element answers as the mirror image (x to -x) of its RVE, so that the bias cancels within each element. A user of
/// the library chooses the points. No RVE is changed: its gradient is mirrored before the evaluation and its answer
/// after it, without rounding.

#include <memory>
#include <vector>

#include "fem/material_batch.hpp"
#include "host/material/snapshot_source.hpp"

namespace voussoir::host {

class MirroredBatch final : public fem::MaterialBatch, public SnapshotSource {
 public:
  /// Mirrors the Gauss points 1 and 3 of each element, which are one of each row and one of each column.
  explicit MirroredBatch(std::unique_ptr<fem::MaterialBatch> batch);
  /// Mirrors these points. @param mirrored (point); throws std::invalid_argument where their number is another one
  MirroredBatch(std::unique_ptr<fem::MaterialBatch> batch, std::vector<bool> mirrored);

  [[nodiscard]] bool is_mirrored(std::size_t point) const { return mirrored_[point]; }

  [[nodiscard]] std::size_t size() const override { return batch_->size(); }
  void begin_increment() override { batch_->begin_increment(); }
  fem::BatchReport evaluate(std::span<const fem::Gradient> gradients, std::span<fem::Stress> stress,
                            std::span<fem::Tangent> tangent) override;
  void commit() override { batch_->commit(); }
  void committed(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const override;
  [[nodiscard]] std::vector<fem::PointField> fields() const override;
  [[nodiscard]] std::vector<std::byte> state() const override { return batch_->state(); }
  void set_state(std::span<const std::byte> bytes) override { batch_->set_state(bytes); }
  void retire(std::span<const std::size_t> points) override { batch_->retire(points); }
  [[nodiscard]] std::shared_ptr<const fem::HeldState> hold() override { return batch_->hold(); }
  void return_to(const fem::HeldState& held) override { batch_->return_to(held); }
  /// The list is empty where the mirrored batch has no grains.
  [[nodiscard]] std::vector<io::RveSnapshot> snapshots(std::span<const std::int64_t> points) const override;

 private:
  void mirror(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const;

  std::unique_ptr<fem::MaterialBatch> batch_;
  std::vector<bool> mirrored_;  ///< (point)
};

}  // namespace voussoir::host
