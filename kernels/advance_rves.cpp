#include "kernels/advance_rves.hpp"

#include <numeric>
#include <vector>

#include "kernels/isa/choose_lanes.hpp"

namespace voussoir::kernels {

namespace {

std::vector<int> all_of(const RveBatch& batch) {
  std::vector<int> rves(batch.size());
  std::iota(rves.begin(), rves.end(), 0);
  return rves;
}

/// To be called before trial states are written.
void forget_motions(RveBatch& batch, std::span<const int> rves) {
  for (const int rve : rves) batch.candidates.spending[static_cast<std::size_t>(rve)] = -1.0;
}

}  // namespace

Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports) {
  return advance(batch, requests, settings, reports, all_of(batch));
}

Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves) {
  forget_motions(batch, rves);
  if (batch.residence) return batch.residence->advance(batch, requests, settings, reports, rves);
  return chosen_lanes().lanes->advance_given(batch, requests, settings, reports, rves);
}

Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports) {
  const std::vector<int> rves = all_of(batch);
  forget_motions(batch, rves);
  if (batch.residence) return batch.residence->advance(batch, requests, settings, reports, rves);
  return chosen_lanes().lanes->advance_servo(batch, requests, settings, reports, rves);
}

}  // namespace voussoir::kernels
