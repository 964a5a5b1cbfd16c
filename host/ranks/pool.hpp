#pragma once
/// One pool of RVEs over all ranks: the first rank's own part, and its conversation with the other ranks. Gauss points
/// are dealt out one by one and not in blocks, so that the costly points near the opening spread over the ranks.

#include <memory>

#include "fem/retired_points.hpp"
#include "host/material/rve_pool.hpp"
#include "host/ranks/channel.hpp"
#include "host/ranks/session.hpp"

namespace voussoir::host {

/// A rank, as `start_ranks` found it.
struct RankInfo {
  std::string host;
  int threads = 1;
  std::string lanes = {};  ///< name of the set that its lanes take
};

/// The points of each rank out of `n`, ascending. Points are dealt out in turn, in proportion to the ranks' threads.
[[nodiscard]] std::vector<std::vector<std::size_t>> deal_points(std::size_t n, std::span<const RankInfo> ranks);

class RankPool final : public fem::MaterialBatch, public SnapshotSource {
 public:
  RankPool(PackingMix mix, const PoolOptions& options, std::span<const RankInfo> ranks, PackingNote note);
  ~RankPool() override;

  [[nodiscard]] std::size_t size() const override { return committed_.size(); }
  void begin_increment() override;
  fem::BatchReport evaluate(std::span<const fem::Gradient> gradients, std::span<fem::Stress> stress,
                            std::span<fem::Tangent> tangent) override;
  void commit() override;
  void committed(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const override;
  [[nodiscard]] std::vector<fem::PointField> fields() const override;
  [[nodiscard]] std::vector<std::byte> state() const override;
  void set_state(std::span<const std::byte> bytes) override;
  void retire(std::span<const std::size_t> points) override;
  [[nodiscard]] std::vector<io::RveSnapshot> snapshots(std::span<const std::int64_t> points) const override;

 private:
  /// The cost of spreading the pool, for the log.
  struct Ledger {
    std::size_t evaluations = 0;
    double bytes = 0;       ///< bytes of the evaluations' messages
    double evaluating = 0;  ///< time of the evaluations [s]
    double slowest = 0;     ///< time of the slowest rank, summed over the evaluations [s]
    double waiting = 0;     ///< time that the first rank waited for the others [s]
  };

  [[nodiscard]] std::uint64_t identity() const { return own_->identity(mix_.of_point); }
  [[nodiscard]] std::size_t others() const { return points_.size() - 1; }
  [[nodiscard]] Message make_message(std::size_t rank) const;
  [[nodiscard]] Message gradient_message(std::size_t rank, std::span<const fem::Gradient> gradients,
                                         bool with_tangents) const;
  [[nodiscard]] std::vector<std::vector<std::byte>> records_of(std::size_t rank, std::size_t first,
                                                               std::size_t n) const;
  void describe_costs();

  PackingMix mix_;
  PoolOptions options_;
  PackingNote note_;
  std::vector<double> least_areas_;               ///< of all points, see least_areas [m^2]
  std::vector<std::vector<std::size_t>> points_;  ///< by rank
  std::unique_ptr<RvePool> own_;
  std::vector<kernels::RveReport> trial_, committed_;  ///< of all points
  fem::RetiredPoints retired_;                         ///< of all points
  Ledger ledger_;
};

}  // namespace voussoir::host
