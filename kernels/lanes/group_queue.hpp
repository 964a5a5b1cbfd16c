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
  using Parked = ParkedLaneOf<Run>;

  enum class Kind {
    fresh,   ///< a group of `members`
    parked,  ///< a group of lanes that were put aside, or have ended alone
    alone    ///< one lane that is to be advanced alone and given back as ended
  };
  struct Task {
    Kind kind = Kind::fresh;
    int packing = 0;
    Members members{};
    std::vector<Parked> parked;
  };

  GroupQueue(const RveBatch& batch, std::vector<Members> groups)
      : batch_(&batch), groups_(std::move(groups)), of_packing_(batch.packings.size()) {
    for (const Members& group : groups_) ++of_packing_[packing_of(group[0])].waiting;
  }

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

  /// Lets no further group begin.
  void stop() {
    const std::lock_guard lock(mutex_);
    first_ = groups_.size();
    for (OfPacking& p : of_packing_) p = {};
  }

  /// Whether a group of a packing, of whose lanes `running` still run, should put these aside. It should where they are
  /// few and will find company, and where so few are left that each of them is faster alone.
  [[nodiscard]] bool wants(const Packing& packing, int running) {
    if (running == 0 || running > few) return false;
    if (running <= most_alone) return true;
    const std::lock_guard lock(mutex_);
    const OfPacking& p = of_packing_[static_cast<std::size_t>(&packing - batch_->packings.data())];
    return p.waiting > 0 || !p.aside.empty();
  }

  /// Takes a lane that runs, or one that has ended alone and is to be finished in a group.
  void put_aside(Parked lane) {
    {
      const std::lock_guard lock(mutex_);
      OfPacking& p = of_packing_[packing_of(lane.course.rve)];
      (lane.course.running ? p.aside : p.ended).push_back(std::move(lane));
    }
    changed_.notify_one();
  }

 private:
  static constexpr int few = width / 3;
  /// One RVE spread over 16 lanes takes less than half of the time of a group for a step. Narrow lanes gain nothing.
  static constexpr int most_alone = width < 8 ? 0 : 2;

  struct OfPacking {
    int waiting = 0;            ///< groups that have not begun
    std::vector<Parked> aside;  ///< lanes that are to go on
    std::vector<Parked> ended;  ///< lanes that have ended alone
  };

  const RveBatch* batch_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Members> groups_;
  std::size_t first_ = 0;  ///< of the groups that have not begun
  std::vector<OfPacking> of_packing_;
  int running_ = 0;

  [[nodiscard]] std::size_t packing_of(int rve) const {
    return static_cast<std::size_t>(batch_->packing_of[static_cast<std::size_t>(rve)]);
  }

  void end_task() {
    {
      const std::lock_guard lock(mutex_);
      --running_;
    }
    changed_.notify_all();
  }

  /// The packing with most lanes in one of its two lists.
  [[nodiscard]] std::size_t fullest(std::vector<Parked> OfPacking::* list) const {
    std::size_t most = 0;
    for (std::size_t p = 1; p < of_packing_.size(); ++p) {
      if ((of_packing_[p].*list).size() > (of_packing_[most].*list).size()) most = p;
    }
    return most;
  }

  static void take_lanes(Task& task, std::size_t packing, std::vector<Parked>& from, std::size_t most) {
    task.packing = static_cast<int>(packing);
    const auto begin = from.end() - static_cast<std::ptrdiff_t>(std::min(from.size(), most));
    task.parked.assign(std::make_move_iterator(begin), std::make_move_iterator(from.end()));
    from.erase(begin, from.end());
  }

  /// Full groups of lanes that were put aside go first, since these have most steps. Smaller ones follow the groups
  /// that were formed at the start. Lanes that have ended alone are finished last, in groups as large as they can be.
  [[nodiscard]] bool take(Task& task) {
    constexpr auto whole = static_cast<std::size_t>(width);
    const std::size_t p = fullest(&OfPacking::aside), q = fullest(&OfPacking::ended);
    auto &aside = of_packing_[p].aside, &ended = of_packing_[q].ended;
    if (aside.size() < whole && first_ < groups_.size()) {
      task.kind = Kind::fresh;
      task.members = groups_[first_++];
      task.packing = static_cast<int>(packing_of(task.members[0]));
      --of_packing_[static_cast<std::size_t>(task.packing)].waiting;
      return true;
    }
    if (!aside.empty()) {
      const bool alone = aside.size() <= static_cast<std::size_t>(most_alone);
      task.kind = alone ? Kind::alone : Kind::parked;
      take_lanes(task, p, aside, alone ? 1 : whole);
      return true;
    }
    if (ended.empty() || (ended.size() < whole && running_ > 0)) return false;
    task.kind = Kind::parked;
    take_lanes(task, q, ended, whole);
    return true;
  }
};

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
