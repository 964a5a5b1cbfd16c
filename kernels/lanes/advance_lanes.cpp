/// The engine of CPUs, one RVE in each SIMD lane, compiled for one instruction set.

#include "kernels/course/choose_instance.hpp"
#include "kernels/isa/lane_set.hpp"
#include "kernels/lanes/group_launch.hpp"
#include "kernels/lanes/wide_lane.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

namespace {

template <class Drive>
Work advance(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves) {
  return choose_instance<WideLane>(batch, settings.precision, [&]<class Law>(Instance<Law>) {
    return launch<Law, Drive>(batch, requests, settings, reports, rves);
  });
}

}  // namespace

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES

#define VOUSSOIR_JOIN(a, b) a##b
#define VOUSSOIR_NAME_OF_SET(set) VOUSSOIR_JOIN(voussoir_lanes_, set)

using namespace voussoir::kernels;

extern "C" const LaneSet VOUSSOIR_NAME_OF_SET(VOUSSOIR_LANES) = {
    .isa = lanes::own_set,
    .floats = lane_count<lanes::WideLane<float>>,
    .doubles = lane_count<lanes::WideLane<double>>,
    .advance_given = lanes::advance<StrainDrive>,
    .advance_servo = lanes::advance<ServoDrive>,
    .find_candidates = lanes::find_candidates,
};
