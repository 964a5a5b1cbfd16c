#pragma once
/// The parts of an evaluation under the method's own names, for profilers.
///
/// Kokkos' own `pushRegion` may fence, which waits for ever inside a parallel loop, and most tools keep one stack of
/// regions for the whole program. So a worker speaks to the tool directly, and only the thread that launched the loop
/// does: a tool sees that thread's share of the work, inside the loop's own kernel. Without a tool a region costs one
/// comparison. Sampling profilers see all threads: VOUSSOIR_OWN_SYMBOL keeps the functions apart that they should name.

#include <Kokkos_Core.hpp>
#include <thread>

/// Of a function that a profiler shall find by its name: never inlined. For functions that run microseconds or longer.
#define VOUSSOIR_OWN_SYMBOL __attribute__((noinline))

namespace voussoir::kernels {

/// Where regions are told; nowhere unless a tool is loaded.
class Regions {
 public:
  Regions() = default;

  /// Of the loaded tool, for the calling thread.
  [[nodiscard]] static Regions of_tool() {
    const auto callbacks = Kokkos::Tools::Experimental::get_callbacks();
    Regions regions;
    if (callbacks.push_region == nullptr || callbacks.pop_region == nullptr) return regions;
    regions.push_ = callbacks.push_region;
    regions.pop_ = callbacks.pop_region;
    regions.thread_ = std::this_thread::get_id();
    return regions;
  }

  /// The same on the thread that asked for them, nowhere on any other.
  [[nodiscard]] Regions of_this_thread() const {
    return push_ != nullptr && std::this_thread::get_id() == thread_ ? *this : Regions();
  }

 private:
  friend class Region;
  void (*push_)(const char*) = nullptr;
  void (*pop_)() = nullptr;
  std::thread::id thread_;
};

/// One region, as long as it lives.
class Region {
 public:
  Region(const Regions& regions, const char* name) : pop_(regions.pop_) {
    if (pop_ != nullptr) regions.push_(name);
  }
  ~Region() {
    if (pop_ != nullptr) pop_();
  }
  Region(const Region&) = delete;
  Region& operator=(const Region&) = delete;

 private:
  void (*pop_)();
};

}  // namespace voussoir::kernels
