#pragma once
/// The groups that workers still have to run: those that were formed at the start, and those that lanes which were put
/// aside make. Which lanes meet depends on the workers' timing; no number of a lane does.

#include <algorithm>
#include <array>
#include <condition_variable>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "kernels/course/rve_report.hpp"
#include "kernels/lanes/park.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// Puts RVEs of one packing side by side, most work first, so that the lanes of a group end together and the longest
/// group starts first.
template <int width, class Request>
std::vector<GroupMembers<width>> form_groups(const RveBatch& batch, std::span<const Request> requests,
                                             std::span<const RveReport> reports, std::span<const int> rves) {
  std::vector<int> order(rves.begin(), rves.end());
  const auto steps = [&](int rve) {
    const auto k = static_cast<std::size_t>(rve);
    return predicted_steps(requests[k], reports[k].steps);
  };
  const auto packing = [&](int rve) { return batch.packing_of[static_cast<std::size_t>(rve)]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return packing(a) != packing(b) ? packing(a) < packing(b) : steps(a) > steps(b);
  });
  std::vector<GroupMembers<width>> groups;
  int lane = width;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (lane == width || packing(order[k]) != packing(order[k - 1])) {
      groups.emplace_back().fill(-1);
      lane = 0;
    }
    groups.back()[static_cast<std::size_t>(lane++)] = order[k];
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const auto& a, const auto& b) { return steps(a[0]) > steps(b[0]); });
  return groups;
}

/// All functions may be called by several workers at once.
template <class Run>
class GroupQueue {
 public:
  static constexpr int width = static_cast<int>(Run::width);
  using Members = GroupMembers<width>;
  using Parked = ParkedLane<typename Run::Law, typename Run::Drive>;

  /// A group to be run: `members`, or lanes that were put aside where there are any.
  struct Task {
    int packing = 0;
    Members members{};
    std::vector<Parked> parked;
  };

  GroupQueue(const RveBatch& batch, std::vector<Members> groups)
      : batch_(&batch), groups_(std::move(groups)), aside_(batch.packings.size()), waiting_(batch.packings.size()) {
    for (const Members& group : groups_) ++waiting_[packing_of(group[0])];
  }

  /// The time in which a worker runs a task.
  class Turn {
   public:
    explicit Turn(GroupQueue& queue) : queue_(&queue) {}
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    ~Turn() { queue_->end_task(); }

   private:
    GroupQueue* queue_;
  };

  /// Waits while other workers run groups whose lanes may still be put aside. False at the end. Where it gives a task,
  /// a `Turn` must follow.
  [[nodiscard]] bool next(Task& task) {
    std::unique_lock lock(mutex_);
    for (;;) {
      if (take(task)) {
        ++running_;
        return true;
      }
      if (running_ == 0) return false;
      changed_.wait(lock);
    }
  }

  /// Lets no further group begin.
  void stop() {
    const std::lock_guard lock(mutex_);
    first_ = groups_.size();
    for (auto& lanes : aside_) lanes.clear();
  }

  /// Whether a group of a packing, of whose lanes `running` still run, should put these aside. It should where they are
  /// few and will find company.
  [[nodiscard]] bool wants(const Packing& packing, int running) {
    if (width == 1 || running == 0 || running > few) return false;
    const std::lock_guard lock(mutex_);
    const auto p = static_cast<std::size_t>(&packing - batch_->packings.data());
    return waiting_[p] > 0 || !aside_[p].empty();
  }

  void put_aside(Parked lane) {
    {
      const std::lock_guard lock(mutex_);
      aside_[static_cast<std::size_t>(batch_->packing_of[static_cast<std::size_t>(lane.course.rve)])].push_back(
          std::move(lane));
    }
    changed_.notify_one();
  }

 private:
  void end_task() {
    {
      const std::lock_guard lock(mutex_);
      --running_;
    }
    changed_.notify_all();
  }

  static constexpr int few = width / 3;

  const RveBatch* batch_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Members> groups_;
  std::size_t first_ = 0;                   ///< of the groups that have not begun
  std::vector<std::vector<Parked>> aside_;  ///< by packing
  std::vector<int> waiting_;                ///< by packing: groups that have not begun
  int running_ = 0;

  [[nodiscard]] std::size_t packing_of(int rve) const {
    return static_cast<std::size_t>(batch_->packing_of[static_cast<std::size_t>(rve)]);
  }

  /// A full group of lanes that were put aside goes first, since these have most steps; a smaller one last.
  [[nodiscard]] bool take(Task& task) {
    const auto most = std::max_element(aside_.begin(), aside_.end(),
                                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
    const std::size_t there = most == aside_.end() ? 0 : most->size();
    if (there < static_cast<std::size_t>(width) && first_ < groups_.size()) {
      task.parked.clear();
      task.members = groups_[first_++];
      task.packing = static_cast<int>(packing_of(task.members[0]));
      --waiting_[static_cast<std::size_t>(task.packing)];
      return true;
    }
    if (there == 0) return false;
    const std::size_t taken = std::min(there, static_cast<std::size_t>(width));
    const auto from = most->end() - static_cast<std::ptrdiff_t>(taken);
    task.parked.assign(std::make_move_iterator(from), std::make_move_iterator(most->end()));
    most->erase(from, most->end());
    task.packing = static_cast<int>(most - aside_.begin());
    return true;
  }
};

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
