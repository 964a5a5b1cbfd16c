#pragma once
/// The parallel loop over groups. Only advance_lanes.cpp and tests with a law of their own include this file, because
/// it takes long to compile.

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "kernels/course/flush_subnormals.hpp"
#include "kernels/lanes/advance_group.hpp"
#include "kernels/lanes/group_queue.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// Runs groups of the queue until there are none. @return the work of this worker without the RVEs' own steps
template <class Run>
Work work_off(Run& run, GroupQueue<Run>& queue, RveBatch& batch, std::span<const typename Run::Drive::Request> requests,
              std::span<RveReport> reports, RegionTeller& teller) {
  Work work;
  typename GroupQueue<Run>::Task task;
  run.batch = &batch;
  while (queue.next(task)) {
    const typename GroupQueue<Run>::Turn running(queue);
    const RegionTeller::Turn turn(teller);
    run.regions = turn.regions();
    run.packing = &batch.packings[static_cast<std::size_t>(task.packing)];
    if (task.parked.empty()) {
      restore(run, task.members, requests);
    } else {
      unpark(run, std::span(task.parked));
    }
    const auto steps = static_cast<std::size_t>(advance_group(run, queue, reports));
    work.lane_steps += steps * static_cast<std::size_t>(run.packing->size()) * Run::width;
  }
  work.tangent_seconds = run.tangent_seconds;
  work.workers = 1;
  return work;
}

/// Advances the RVEs `rves` in groups on all cores of the host.
/// @throws std::invalid_argument where the batch's histories are not the law's
template <class Law, class Drive>
Work launch(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
            std::span<RveReport> reports, std::span<const int> rves) {
  using Space = Kokkos::DefaultHostExecutionSpace;
  using Run = GroupRun<Law, Drive>;
  if (batch.committed.history_size() != static_cast<std::size_t>(history_size<Law>)) {
    throw std::invalid_argument("lanes: the batch holds the histories of another law");
  }
  auto groups = form_groups<lane_count<typename Law::Value>, typename Drive::Request>(batch, requests, reports, rves);
  const Space space;
  const std::size_t workers = std::min(groups.size(), static_cast<std::size_t>(space.concurrency()));
  GroupQueue<Run> queue(batch, std::move(groups));
  RegionTeller teller;
  std::exception_ptr failure;
  std::atomic_flag failed;
  std::mutex adding;
  Work work;
  Kokkos::parallel_for(
      "voussoir::lanes::groups",
      Kokkos::RangePolicy<Space, Kokkos::Schedule<Kokkos::Dynamic>>(space, 0, workers).set_chunk_size(1),
      [&](std::size_t) {
        const FlushSubnormals flush;
        try {
          const auto run = std::make_unique<Run>();
          run->settings = settings;
          const Work done = work_off(*run, queue, batch, requests, reports, teller);
          const std::lock_guard lock(adding);
          work += done;
        } catch (...) {  // for example no memory; an exception may leave the parallel region only in this way
          if (!failed.test_and_set()) failure = std::current_exception();
          queue.stop();
        }
      });
  space.fence("voussoir::lanes::groups");
  if (failure) std::rethrow_exception(failure);
  for (const int rve : rves) {
    const auto k = static_cast<std::size_t>(rve);
    work.particle_steps += static_cast<std::size_t>(batch.packing(k).size()) *
                           static_cast<std::size_t>(reports[k].steps);
  }
  return work;
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
