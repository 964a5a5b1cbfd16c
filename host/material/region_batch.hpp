#pragma once
/// Several batches as the material of one mesh: grains in some regions of it, elastic ground in others.

#include <memory>
#include <string>
#include <vector>

#include "fem/material_batch.hpp"
#include "fem/retired_points.hpp"
#include "host/material/snapshot_source.hpp"

namespace voussoir::host {

/// A batch, and the points of the mesh that it answers for.
struct RegionPart {
  std::unique_ptr<fem::MaterialBatch> batch;
  std::vector<std::size_t> points;  ///< (point of the batch) number of the mesh's point, ascending
};

/// Points are those of the mesh everywhere; only messages come from the parts as they are (PackingMix::numbers). A
/// point whose part does not have a field has NaN there.
class RegionBatch final : public fem::MaterialBatch, public SnapshotSource {
 public:
  /// Throws std::invalid_argument unless each of the points 0, 1, ... belongs to one part.
  explicit RegionBatch(std::vector<RegionPart> parts);

  [[nodiscard]] std::size_t size() const override { return part_of_.size(); }
  void begin_increment() override;
  fem::BatchReport evaluate(std::span<const fem::Gradient> gradients, std::span<fem::Stress> stress,
                            std::span<fem::Tangent> tangent) override;
  void commit() override;
  void committed(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const override;
  [[nodiscard]] std::vector<fem::PointField> fields() const override;
  [[nodiscard]] std::vector<std::byte> state() const override;
  void set_state(std::span<const std::byte> bytes) override;
  void retire(std::span<const std::size_t> points) override;
  /// Each part holds its own state, a pool without a copy.
  [[nodiscard]] std::shared_ptr<const fem::HeldState> hold() override;
  void return_to(const fem::HeldState& held) override;
  /// Points without grains have no snapshot.
  [[nodiscard]] std::vector<io::RveSnapshot> snapshots(std::span<const std::int64_t> points) const override;

 private:
  struct Place {
    std::size_t part = 0;
    std::size_t point = 0;  ///< of the part
  };

  [[nodiscard]] fem::BatchReport joined(const std::vector<fem::BatchReport>& reports) const;

  std::vector<RegionPart> parts_;
  std::vector<Place> part_of_;               ///< (point of the mesh)
  std::vector<fem::RetiredPoints> retired_;  ///< of each part
};

}  // namespace voussoir::host
