#pragma once
/// The parts of an evaluation under the method's own names, for profilers.
///
/// Kokkos' own `pushRegion` may fence, which waits for ever inside a parallel loop, and most tools keep one stack of
/// regions for the whole program. So a worker speaks to the tool directly, and one worker at a time does: who begins a
/// group while no other is told tells it from its beginning to its end. A tool sees a sample of the groups, inside the
/// loop's own kernel. Without a tool a region costs one comparison. Sampling profilers see all threads:
/// VOUSSOIR_OWN_SYMBOL keeps the functions apart that they should name.

#include <Kokkos_Core.hpp>
#include <atomic>

/// Of a function that a profiler shall find by its name: never inlined. For functions that run microseconds or longer.
#define VOUSSOIR_OWN_SYMBOL __attribute__((noinline))

namespace voussoir::kernels {

/// Where regions are told; nowhere by default.
class Regions {
 public:
  Regions() = default;

  /// The loaded tool, or nowhere.
  [[nodiscard]] static Regions of_tool() {
    const auto callbacks = Kokkos::Tools::Experimental::get_callbacks();
    Regions regions;
    if (callbacks.push_region == nullptr || callbacks.pop_region == nullptr) return regions;
    regions.push_ = callbacks.push_region;
    regions.pop_ = callbacks.pop_region;
    return regions;
  }

  [[nodiscard]] bool told() const { return push_ != nullptr; }

 private:
  friend class Region;
  void (*push_)(const char*) = nullptr;
  void (*pop_)() = nullptr;
};

/// Lets one worker of a parallel loop at a time tell its regions.
class RegionTeller {
 public:
  /// A worker's turn, as long as it lives; `regions` are told where no other worker has one.
  class Turn {
   public:
    explicit Turn(RegionTeller& teller) : teller_(teller) {
      if (teller.tool_.told() && !teller.taken_.test_and_set(std::memory_order_acquire)) regions_ = teller.tool_;
    }
    ~Turn() {
      if (regions_.told()) teller_.taken_.clear(std::memory_order_release);
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    [[nodiscard]] const Regions& regions() const { return regions_; }

   private:
    RegionTeller& teller_;
    Regions regions_;
  };

 private:
  Regions tool_ = Regions::of_tool();
  std::atomic_flag taken_;
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
