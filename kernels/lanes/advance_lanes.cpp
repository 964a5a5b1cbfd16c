#include "kernels/lanes/advance_lanes.hpp"

#include "kernels/course/choose_instance.hpp"
#include "kernels/lanes/group_launch.hpp"

namespace voussoir::kernels::lanes {

namespace {

template <class Drive>
Work advance_with(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
                  std::span<RveReport> reports, std::span<const int> rves) {
  return choose_instance<Width::widest>(batch, settings.precision, [&]<class Law>(Instance<Law>) {
    return launch<Law, Drive>(batch, requests, settings, reports, rves);
  });
}

}  // namespace

Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves) {
  return advance_with<StrainDrive>(batch, requests, settings, reports, rves);
}

Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves) {
  return advance_with<ServoDrive>(batch, requests, settings, reports, rves);
}

}  // namespace voussoir::kernels::lanes
