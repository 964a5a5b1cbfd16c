/// The engine of CPUs, one RVE in each SIMD lane, compiled for one instruction set.

#include "kernels/course/choose_instance.hpp"
#include "kernels/isa/lane_set.hpp"
#include "kernels/lanes/committed_network.hpp"
#include "kernels/lanes/group_launch.hpp"
#include "kernels/lanes/wide_lane.hpp"

#if defined(VOUSSOIR_JOINED)
/// The constructors of static objects of this set, between two symbols that kernels/instruction_sets.cmake makes.
extern "C" {
using VoussoirStart = void (*)();
extern const VoussoirStart voussoir_starts[];
extern const VoussoirStart voussoir_starts_end[];
}
#endif

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

namespace {

/// Nothing is to be done for the plain set, whose constructors run before main.
void begin() {
#if defined(VOUSSOIR_JOINED)
  for (const VoussoirStart* start = voussoir_starts; start != voussoir_starts_end; ++start) (*start)();
#endif
}

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

namespace kernels = voussoir::kernels;

extern "C" const kernels::LaneSet VOUSSOIR_NAME_OF_SET(VOUSSOIR_LANES) = {
    .isa = kernels::lanes::own_set,
    .floats = kernels::lane_count<kernels::lanes::WideLane<float>>,
    .doubles = kernels::lane_count<kernels::lanes::WideLane<double>>,
    .begin = kernels::lanes::begin,
    .advance_given = kernels::lanes::advance<kernels::StrainDrive>,
    .advance_servo = kernels::lanes::advance<kernels::ServoDrive>,
    .find_candidates = kernels::lanes::find_candidates,
    .committed_network = kernels::lanes::committed_network,
};
