#pragma once
/// How many threads the engine, the assembly and the solver take, and why; the start of Kokkos with this number.

#include <Kokkos_Core.hpp>
#include <functional>
#include <optional>
#include <string>

#include "host/process/cores.hpp"

namespace voussoir::host {

struct ThreadLimits {
  int pool = 1;    ///< threads that Kokkos can hold
  int openmp = 1;  ///< OMP_THREAD_LIMIT
};

/// Value of an environment variable; nullptr where it is not set.
using Environment = std::function<const char*(const char*)>;

struct ThreadChoice {
  int count = 1;
  std::string note;  ///< a line for the log: the number and its reason
};

/// The number of threads: what is `asked` for (0: nothing), or else KOKKOS_NUM_THREADS, or else OMP_NUM_THREADS, or
/// else one for each core that is available; at most as many as both limits allow.
[[nodiscard]] ThreadChoice choose_threads(int asked, const Cores& cores, const ThreadLimits& limits,
                                          const Environment& environment);

/// Threads that Kokkos' pool can hold at most, in this build.
[[nodiscard]] int most_threads();

/// Kokkos from the constructor to the destructor.
class KokkosSession {
 public:
  /// @param threads wanted number, 0 for the default
  explicit KokkosSession(int threads);
  [[nodiscard]] const ThreadChoice& threads() const { return choice_; }

 private:
  ThreadChoice choice_;
  std::optional<Kokkos::ScopeGuard> kokkos_;
};

}  // namespace voussoir::host
