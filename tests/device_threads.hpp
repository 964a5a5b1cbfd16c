#pragma once
/// Blocks of several host threads: the engine of GPUs as a GPU runs it, with barriers that threads really wait at, so
/// that a sanitizer sees every access that no barrier orders.
///
/// A barrier is known by the place of its call, and one such place can be left out, which a sanitizer must then report.

#include <pthread.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <source_location>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "kernels/device/host_backend.hpp"

namespace voussoir::kernels::device {

/// The places from which barriers are called. One of them is called FUNCTION#N, the N-th of its function, so that the
/// name outlives changes of the lines above it.
class BarrierPlaces {
 public:
  static inline bool noting = false;    ///< to be switched on for blocks of one thread alone
  static inline unsigned left_out = 0;  ///< line; 0: none
  static inline std::string file_left_out;

  static void note(const std::source_location& from) {
    lines[function_of(from)].insert({from.line(), from.file_name()});
  }
  [[nodiscard]] static bool is_left_out(const std::source_location& from) {
    return left_out == from.line() && file_left_out == from.file_name();
  }
  /// Leaves out a barrier that was noted. @throws std::invalid_argument where there is none of that name
  static void leave_out(const std::string& name) {
    for (const auto& [function, places] : lines) {
      int number = 0;
      for (const auto& [line, file] : places) {
        if (function + "#" + std::to_string(++number) != name) continue;
        file_left_out = file;
        left_out = line;
        return;
      }
    }
    throw std::invalid_argument("no barrier is called " + name);
  }
  [[nodiscard]] static std::vector<std::string> names() {
    std::vector<std::string> all;
    for (const auto& [function, places] : lines)
      for (std::size_t k = 0; k < places.size(); ++k) all.push_back(function + "#" + std::to_string(k + 1));
    return all;
  }

 private:
  static inline std::map<std::string, std::set<std::pair<unsigned, std::string>>> lines;

  [[nodiscard]] static std::string function_of(const std::source_location& from) {
    const std::string_view name = from.function_name();
    const std::string_view path = name.substr(0, name.find('('));
    return std::string(path.substr(path.rfind(':') + 1));
  }
};

/// What the threads of a block wait at: two barriers by turns. With one alone ThreadSanitizer would miss races, because
/// a thread that wakes up late from it would seem to be ordered after those that have already come to it again.
class ThreadBarrier {
 public:
  explicit ThreadBarrier(int threads) {
    for (auto& barrier : barriers_) pthread_barrier_init(&barrier, nullptr, static_cast<unsigned>(threads));
  }
  ThreadBarrier(const ThreadBarrier&) = delete;
  ThreadBarrier& operator=(const ThreadBarrier&) = delete;
  ~ThreadBarrier() {
    for (auto& barrier : barriers_) pthread_barrier_destroy(&barrier);
  }
  /// @param turn of the calling thread, which changes
  void wait(int& turn) {
    pthread_barrier_wait(&barriers_[turn]);
    turn = 1 - turn;
  }

 private:
  pthread_barrier_t barriers_[2]{};
};

/// One thread of a block.
class ThreadBlock {
 public:
  /// @param turn of the thread at the barriers, 0 at first
  ThreadBlock(ThreadBarrier& barrier, int& turn, int thread, int threads, char* fast)
      : barrier_(&barrier), turn_(&turn), thread_(thread), threads_(threads), fast_(fast) {}
  [[nodiscard]] char* fast_memory() const { return fast_; }
  [[nodiscard]] int thread() const { return thread_; }
  [[nodiscard]] int threads() const { return threads_; }
  void barrier(const std::source_location& from = std::source_location::current()) const {
    if (BarrierPlaces::noting) BarrierPlaces::note(from);
    if (BarrierPlaces::left_out != 0 && BarrierPlaces::is_left_out(from)) return;
    barrier_->wait(*turn_);
  }

 private:
  ThreadBarrier* barrier_;
  int* turn_;
  int thread_, threads_;
  char* fast_;
};

/// A device whose blocks are host threads. Its memory is never zero where it was not written to.
/// @tparam Plan of the first level, if the grains fit it; the levels after it keep pairs and grains in memory
template <class Plan = InMemory>
struct ThreadBackend {
  static inline int threads = 2;      ///< of a block
  static inline int first_pairs = 0;  ///< room of the first level, where it is in memory; 0: it is left out
  static inline int blocks_run = 0;   ///< of all launches so far

  static constexpr int levels = 1 + HostBackend::levels;
  static constexpr bool follows_stresses = true;
  static constexpr int rubbish = 0xfe;  ///< in each byte: a negative integer, a negative number of 1e303 or NaN-like
                                        ///< float

  [[nodiscard]] static void* allocate(std::size_t bytes) {
    void* const p = HostBackend::allocate(bytes);
    std::memset(p, rubbish, bytes);
    return p;
  }
  static void release(void* p) { HostBackend::release(p); }
  static void copy_up(void* to, const void* from, std::size_t bytes) { HostBackend::copy_up(to, from, bytes); }
  static void copy_down(void* to, const void* from, std::size_t bytes) { HostBackend::copy_down(to, from, bytes); }
  static void copy_committed(const DeviceStates& from, const DeviceStates& to) {
    HostBackend::copy_committed(from, to);
  }
  using WayBeside = HostBackend::WayBeside;

  template <class Law, class Drive>
  [[nodiscard]] static int level_from(int level, int grains) {
    if (level > 0) return level;
    if (Plan::in_registers) return grains <= Plan::grain_slots * threads ? 0 : 1;
    return first_pairs > 0 ? 0 : 1;
  }
  template <class Law, class Drive>
  [[nodiscard]] static int room(int level, int grains) {
    if (level > 0) return HostBackend::room<Law, Drive>(level - 1, grains);
    return Plan::in_registers ? Plan::pair_slots * threads : first_pairs;
  }

  template <class Law, class Drive, bool classes>
  static void launch(const BlockBatch<real_of<typename Law::Value>, Drive>& batch, const EngineSettings& settings,
                     int level, int blocks, int pairs) {
    blocks_run += blocks;
    if (level == 0) return launch_with<Law, Drive, Plan, classes>(batch, settings, blocks, pairs);
    launch_with<Law, Drive, InMemory, classes>(batch, settings, blocks, pairs);
  }

  static void describe(const NetworkBatch& batch) {
    const NetworkMemory sizes(no_memory(), threads);
    for (int rve = 0; rve < batch.states.rves; ++rve) {
      char* const fast = static_cast<char*>(allocate(sizes.bytes));
      on_threads(fast, [&](const ThreadBlock& block) { describe_block(block, batch, rve); });
      release(fast);
    }
  }

 private:
  /// Calls body(block) by all threads of one block.
  template <class Body>
  static void on_threads(char* fast, const Body& body) {
    ThreadBarrier barrier(threads);
    std::vector<std::thread> all;
    for (int t = 0; t < threads; ++t) {
      all.emplace_back([&, t] {
        int turn = 0;
        body(ThreadBlock(barrier, turn, t, threads, fast));
      });
    }
    for (std::thread& t : all) t.join();
  }

  template <class Law, class Drive, class OwnPlan, bool classes>
  static void launch_with(const BlockBatch<real_of<typename Law::Value>, Drive>& batch, const EngineSettings& settings,
                          int blocks, int pairs) {
    using Run = BlockRun<Law, Drive, ThreadBlock, OwnPlan, classes>;
    const int grains = batch.packings.stride;
    const BlockMemory<Law, Drive, OwnPlan> sizes(no_memory(), no_memory(), grains, pairs, threads);
    // One block after another, each with memory of its own, as a block on a GPU finds it: not cleared.
    for (int number = 0; number < blocks; ++number) {
      char *const fast = static_cast<char*>(allocate(sizes.fast_bytes)), *const slow = static_cast<char*>(
                                                                             allocate(sizes.slow_bytes));
      on_threads(fast, [&](const ThreadBlock& block) {
        advance_block<Run>({block, &batch, &settings, slow, number, grains, pairs});
      });
      release(fast);
      release(slow);
    }
  }
};

}  // namespace voussoir::kernels::device
