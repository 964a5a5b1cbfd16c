#pragma once
/// The parts of an evaluation under the method's own names, for profilers.
///
/// Kokkos' own `pushRegion` may fence, which waits for ever inside a parallel loop, and most tools keep one stack of
/// regions for the whole program. So workers call the tool directly, and only one worker at a time does: a worker
/// that begins a group while no other is reporting reports this group from its beginning to its end. A tool sees a
/// sample of the groups, inside the loop's own kernel. Without a tool a region costs one comparison. Sampling profilers
/// see all threads; for them VOUSSOIR_OWN_SYMBOL keeps the parts as functions of their own.

#include <Kokkos_Core.hpp>
#include <atomic>

/// Marks a function that a sampling profiler shall find by its name: it is never inlined. A call costs nothing in
/// functions that run for microseconds.
#define VOUSSOIR_OWN_SYMBOL __attribute__((noinline))

namespace voussoir::kernels {

/// The receiver of regions; by default there is none.
class Regions {
 public:
  Regions() = default;

  /// The loaded tool, or no receiver.
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

/// Lets one worker of a parallel loop at a time report its regions.
class RegionTeller {
 public:
  /// A worker's turn, as long as the object lives. Its regions are reported unless another worker has its turn.
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

/// One region, as long as the object lives.
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
