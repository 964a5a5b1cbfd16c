#pragma once
/// A block: the threads that advance one RVE together. The engine of GPUs is a template over it, so that the same code
/// runs on a GPU (cuda/) and on a host, where one thread is a block (`SerialBlock`) or, in tests, several threads are.
///
/// A block has the functions thread(), threads(), fast_memory() and barrier(). After a barrier, every thread sees what
/// the others wrote before it.

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdint>

/// Marks functions outside the loop of steps. A GPU's compiler must not inline them, because the loop's own numbers
/// would have to leave the registers for theirs.
#if defined(__CUDACC__)
#define VOUSSOIR_COLD_FUNCTION __host__ __device__ __noinline__
#else
#define VOUSSOIR_COLD_FUNCTION inline
#endif

namespace voussoir::kernels::device {

/// One thread that is a block by itself.
struct SerialBlock {
  char* memory;

  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION char* fast_memory() const { return memory; }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION static constexpr int thread() { return 0; }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION static constexpr int threads() { return 1; }
  KOKKOS_FORCEINLINE_FUNCTION static void barrier() {}
};

/// How many pairs and grains a thread keeps in registers. With 0 they stand in memory, as many as there are.
template <int PairSlots, int GrainSlots>
struct BlockPlan {
  static constexpr int pair_slots = PairSlots, grain_slots = GrainSlots;
  static constexpr bool in_registers = PairSlots > 0;
};
using InMemory = BlockPlan<0, 0>;

/// The items of a thread: number k of thread t is item k * threads + t of the block, so that neighbouring threads have
/// neighbouring items.
template <class T, int count>
class Slots {
 public:
  KOKKOS_FORCEINLINE_FUNCTION Slots(T*, int, int, int) {}
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION static constexpr int size() { return count; }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION T& operator[](int k) { return items_[k]; }

 private:
  T items_[count];
};

/// The same in memory.
template <class T>
class Slots<T, 0> {
 public:
  /// @param memory with room for `items` items of the block
  KOKKOS_FORCEINLINE_FUNCTION Slots(T* memory, int items, int thread, int threads)
      : first_(memory + thread), stride_(threads), size_((items - thread + threads - 1) / threads) {}
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int size() const { return size_; }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION T& operator[](int k) { return first_[k * stride_]; }

 private:
  T* first_;
  int stride_, size_;
};

/// Stands for a memory of which only the size is wanted.
[[nodiscard]] inline char* no_memory() {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): nothing is read there, and a null pointer must not be moved.
  return reinterpret_cast<char*>(std::uintptr_t(4096));
}

/// Four or two numbers that are loaded and stored at once.
template <class real>
struct alignas(4 * sizeof(real)) Four {
  real x, y, z, w;
};
template <class real>
struct alignas(2 * sizeof(real)) Two {
  real x, y;
};

inline constexpr int levels_in_memory = 3;

/// Pairs for which a block has room whose pairs are in memory: twice with room for lists of usual and of wide skins,
/// which have 2 to 4 pairs a grain, and then for all pairs, as far as 32 bits number the entries of both grains.
[[nodiscard]] inline int room_in_memory(int level, int grains) {
  constexpr std::int64_t most = std::int64_t(1) << 29;
  const std::int64_t n = grains, of_all = std::max(n * (n - 1) / 2, 2 * n);
  const std::int64_t few = (level == 0 ? 8 : 64) * n;
  return static_cast<int>(std::min(most, level + 1 == levels_in_memory ? of_all : std::min(few, of_all)));
}

/// Gives out pieces of a memory, one after another.
class Carver {
 public:
  KOKKOS_INLINE_FUNCTION explicit Carver(char* memory) : memory_(memory) {}

  template <class T>
  [[nodiscard]] KOKKOS_INLINE_FUNCTION T* take(int count) {
    constexpr std::size_t least = 16;
    constexpr std::size_t alignment = alignof(T) > least ? alignof(T) : least;
    used_ = (used_ + alignment - 1) / alignment * alignment;
    T* const out = reinterpret_cast<T*>(memory_ + used_);
    used_ += sizeof(T) * static_cast<std::size_t>(count);
    return out;
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION std::size_t used() const { return used_; }

 private:
  char* memory_;
  std::size_t used_ = 0;
};

}  // namespace voussoir::kernels::device
