#pragma once
/// The device that is no device: blocks on the cores of the host, in its memory. It is the engine of a GPU without a
/// GPU, for tests; the lanes do the same work much faster. Its threads are OpenMP's and not those of Kokkos, because a
/// library that is opened at run time has a Kokkos of its own that nobody starts.
///
/// A backend has
///   allocate(bytes), release(p), copy_up(to, from, bytes), copy_down(to, from, bytes)   the device's memory
///   copy_committed(from, to)        copy_committed_state for all RVEs
///   WayBeside                       its copy_down may run beside the other functions, in a thread of its own
///   follows_stresses                whether servo drives are compiled
///   levels                          how many instances with ever more room there are
///   level_from<Law, Drive>(level, grains)   the first of them from `level` on that the device grants and the grains
///   fit room<Law, Drive>(level, grains) pairs for which a block of a level has room launch<Law, Drive, classes>(batch,
///   settings, level, blocks, pairs)   advances the RVEs order[0 .. blocks - 1], and
///                                   returns when all have ended
///   describe(batch)                 describes the committed states of all RVEs (block_network.hpp)

#include <cstring>
#include <new>
#include <vector>

#include "kernels/device/block_advance.hpp"
#include "kernels/device/block_copy.hpp"
#include "kernels/device/block_network.hpp"

namespace voussoir::kernels::device {

struct HostBackend {
  static constexpr std::align_val_t line{64};
  static constexpr int levels = 3;
  static constexpr bool follows_stresses = true;

  [[nodiscard]] static void* allocate(std::size_t bytes) { return ::operator new(bytes, line); }
  static void release(void* p) { ::operator delete(p, line); }
  static void copy_up(void* to, const void* from, std::size_t bytes) {
    if (bytes > 0) std::memcpy(to, from, bytes);
  }
  static void copy_down(void* to, const void* from, std::size_t bytes) { copy_up(to, from, bytes); }

  static void copy_committed(const DeviceStates& from, const DeviceStates& to) {
    for (int rve = 0; rve < from.rves; ++rve) copy_committed_state(SerialBlock{nullptr}, from, to, rve);
  }
  struct WayBeside {
    static void copy_down(void* to, const void* from, std::size_t bytes) { HostBackend::copy_down(to, from, bytes); }
  };

  /// The first level from `level` on that serves packings of so many grains on this device.
  template <class Law, class Drive>
  [[nodiscard]] static int level_from(int level, int) {
    return level;
  }
  /// A list with a skin of usual size has 2 to 4 pairs for each grain; the last level has room for all pairs.
  template <class Law, class Drive>
  [[nodiscard]] static int room(int level, int grains) {
    return std::max(room_in_memory(level, grains), 64);
  }

  template <class Law, class Drive, bool classes>
  static void launch(const BlockBatch<real_of<typename Law::Value>, Drive>& batch, const EngineSettings& settings, int,
                     int blocks, int pairs) {
    using Memory = BlockMemory<Law, Drive, InMemory>;
    const Memory sizes(no_memory(), no_memory(), batch.packings.stride, pairs, 1);
#if defined(_OPENMP)
#pragma omp parallel for schedule(dynamic, 1)
#endif
    for (int number = 0; number < blocks; ++number) {
      const HostMemory fast(sizes.fast_bytes), slow(sizes.slow_bytes);
      using Run = BlockRun<Law, Drive, SerialBlock, InMemory, classes>;
      advance_block<Run>(
          {SerialBlock{fast.data()}, &batch, &settings, slow.data(), number, batch.packings.stride, pairs});
    }
  }

  static void describe(const NetworkBatch& batch) {
    const NetworkMemory sizes(no_memory(), 1);
#if defined(_OPENMP)
#pragma omp parallel for schedule(dynamic, 1)
#endif
    for (int rve = 0; rve < batch.states.rves; ++rve) {
      const HostMemory fast(sizes.bytes);
      describe_block(SerialBlock{fast.data()}, batch, rve);
    }
  }

  /// The memory of one block.
  class HostMemory {
   public:
    explicit HostMemory(std::size_t bytes) : data_(static_cast<char*>(allocate(bytes))) {}
    HostMemory(const HostMemory&) = delete;
    HostMemory& operator=(const HostMemory&) = delete;
    ~HostMemory() { release(data_); }
    [[nodiscard]] char* data() const { return data_; }

   private:
    char* data_;
  };
};

}  // namespace voussoir::kernels::device
