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
#include "kernels/state/stop_request.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// A worker: its group, and the RVE that it advances alone.
template <class Run>
class Worker {
 public:
  using Queue = GroupQueue<Run>;
  using Alone = GroupRun<typename LawOver<typename Run::Law, SingleLane<typename Run::real>>::type,
                         typename Run::Drive>;

  /// @param stop flag of the thread that has called; or null
  Worker(RveBatch& batch, const EngineSettings& settings, const std::atomic<bool>* stop)
      : batch_(&batch), settings_(settings), stop_(stop), group_(std::make_unique<Run>()) {}

  /// Runs tasks of the queue until there are none. @return the work of this worker without the RVEs' own steps
  [[nodiscard]] Work work_off(Queue& queue, std::span<const typename Run::Drive::Request> requests,
                              std::span<RveReport> reports, RegionTeller& teller) {
    Work work;
    typename Queue::Task task;
    while (queue.next(task)) {
      const typename Queue::Turn running(queue);
      const RegionTeller::Turn turn(teller);
      const auto grains = static_cast<std::size_t>(packing_of(task).size());
      if (task.kind == Queue::Kind::alone) {
        work.lane_steps += grains * static_cast<std::size_t>(advance_one(queue, task, turn));
        continue;
      }
      prepare(*group_, task, turn);
      if (task.kind == Queue::Kind::fresh) {
        restore(*group_, task.members, requests);
      } else {
        unpark(*group_, std::span(task.parked));
      }
      work.lane_steps += grains * Run::width * static_cast<std::size_t>(advance_group(*group_, queue, reports));
    }
    work.tangent_seconds = group_->tangent_seconds;
    work.workers = 1;
    return work;
  }

 private:
  RveBatch* batch_;
  EngineSettings settings_;
  const std::atomic<bool>* stop_;
  std::unique_ptr<Run> group_;
  std::unique_ptr<Alone> alone_;

  [[nodiscard]] const Packing& packing_of(const typename Queue::Task& task) const {
    return batch_->packings[static_cast<std::size_t>(task.packing)];
  }

  template <class AnyRun>
  void prepare(AnyRun& run, const typename Queue::Task& task, const RegionTeller::Turn& turn) {
    run.batch = batch_;
    run.settings = settings_;
    run.stop = stop_;
    run.packing = &packing_of(task);
    run.regions = turn.regions();
  }

  /// @return the steps made
  [[nodiscard]] int advance_one(Queue& queue, typename Queue::Task& task, const RegionTeller::Turn& turn) {
    if (!alone_) alone_ = std::make_unique<Alone>();
    prepare(*alone_, task, turn);
    unpark(*alone_, std::span(task.parked));
    int steps = 0;
    queue.put_aside(advance_alone(*alone_, steps));
    return steps;
  }
};

/// Advances the RVEs `rves` in groups on all cores of the host.
/// @throws std::invalid_argument where the batch's histories are not the law's; Stopped
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
  const std::atomic<bool>* const stop = stop_flag();
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
          const Work done = Worker<Run>(batch, settings, stop).work_off(queue, requests, reports, teller);
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
