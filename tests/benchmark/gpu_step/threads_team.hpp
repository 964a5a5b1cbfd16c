#pragma once
/// Blocks of threads on a host: one block after the other, its threads as threads of the host. ThreadSanitizer then
/// reports each pair of conflicting accesses that no barrier orders, whatever the timing was.

#include <array>
#include <barrier>
#include <cstddef>
#include <memory>
#include <thread>
#include <vector>

namespace voussoir::gpu_step {

/// The sum of 32 numbers in the order of CudaTeam::warp_sum.
template <class T>
T sum_by_halves(std::array<T, 32> x) {
  for (std::size_t half = 16; half > 0; half /= 2) {
    for (std::size_t k = 0; k < half; ++k) x[k] += x[k + half];
  }
  return x[0];
}

/// What the threads of a block have in common.
template <int threads>
struct BlockOnThreads {
  static_assert(threads % 32 == 0);
  static constexpr std::size_t warps = threads / 32;

  explicit BlockOnThreads(std::size_t shared_bytes) : shared(shared_bytes / sizeof(Line) + 1) {
    for (auto& one : warp) one = std::make_unique<std::barrier<>>(32);
  }

  struct alignas(32) Line {
    std::array<char, 32> bytes;
  };
  std::vector<Line> shared;
  std::barrier<> all{threads};
  std::array<std::unique_ptr<std::barrier<>>, warps> warp;
  std::array<double, threads> slot{};  ///< what threads of a warp tell each other; a float or an int is exact in it
};

/// One thread of such a block. @tparam left_out the number of a barrier of the block, from 1, that all its threads pass
/// without waiting, which a test must find; 0: none
template <int team_threads, int left_out = 0>
class ThreadsTeam {
 public:
  static constexpr int threads = team_threads;

  ThreadsTeam(BlockOnThreads<threads>& block, int rank, int rve) : block_(block), rank_(rank), rve_(rve) {}

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int rve() const { return rve_; }
  void barrier() const {
    if (++barriers_ != left_out) block_.all.arrive_and_wait();
  }
  [[nodiscard]] char* shared() const { return block_.shared.data()->bytes.data(); }

  template <class T>
  T warp_sum(T x) const {
    return sum_by_halves(tell(x));
  }

  [[nodiscard]] int warp_sum_before(int x) const {
    const std::array<int, 32> all = tell(x);
    int sum = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(rank_ % 32); ++k) sum += all[k];
    return sum;
  }

  int add(int& counter, int more) const { return __atomic_fetch_add(&counter, more, __ATOMIC_RELAXED); }

 private:
  /// Every thread of the warp learns what all of them have.
  template <class T>
  std::array<T, 32> tell(T own) const {
    auto& barrier = *block_.warp[static_cast<std::size_t>(rank_ / 32)];
    block_.slot[static_cast<std::size_t>(rank_)] = static_cast<double>(own);
    barrier.arrive_and_wait();
    std::array<T, 32> all;
    const auto first = static_cast<std::size_t>(rank_) / 32 * 32;
    for (std::size_t k = 0; k < 32; ++k) all[k] = static_cast<T>(block_.slot[first + k]);
    barrier.arrive_and_wait();
    return all;
  }

  BlockOnThreads<threads>& block_;
  int rank_, rve_;
  mutable int barriers_ = 0;  ///< that this thread has come to
};

/// Runs `body(team)` for `rves` blocks, each of `Team::threads` threads with `shared_bytes` of memory in common.
template <class Team, class Body>
void run_on_threads(int rves, std::size_t shared_bytes, const Body& body) {
  for (int rve = 0; rve < rves; ++rve) {
    BlockOnThreads<Team::threads> block(shared_bytes);
    std::vector<std::thread> threads;
    for (int rank = 0; rank < Team::threads; ++rank) {
      threads.emplace_back([&block, &body, rank, rve] {
        Team team(block, rank, rve);
        body(team);
      });
    }
    for (auto& thread : threads) thread.join();
  }
}

}  // namespace voussoir::gpu_step
