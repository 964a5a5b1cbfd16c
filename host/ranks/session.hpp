#pragma once
/// A run of several processes: a launcher such as mpirun starts the ranks, the RVEs of a mesh are spread over them, and
/// everything else (case, mesh, Newton, files, log) stays on the first rank. The first rank asks and the others only
/// answer, so that no rank can wait for a message that does not come. A build without MPI has these functions too
/// (none.cpp); it has one rank and no pool of ranks.

#include <memory>
#include <string>

#include "host/case/case.hpp"
#include "host/packing/packings.hpp"

namespace voussoir::fem {
class MaterialBatch;
}

namespace voussoir::host {

struct PoolOptions;

/// `main` holds a session as long as the program runs. MPI is started only where the environment of a launcher says
/// that there may be other ranks.
class RankSession {
 public:
  RankSession();
  ~RankSession();  ///< on the first rank: tells the others to end
  RankSession(const RankSession&) = delete;
  RankSession& operator=(const RankSession&) = delete;

  [[nodiscard]] bool serves() const;  ///< true on all ranks but the first: they have to call `serve` only
  /// Answers the first rank until the first rank ends. Returns 0, since the first rank's exit code
  /// says how the run ended. Ctrl-C, SIGTERM, SIGHUP and SIGUSR1 are ignored here; the first rank obeys them.
  [[nodiscard]] int serve() const;
};

[[nodiscard]] int rank_count();

/// The number of this process among those of its machine. MPI says it, because launchers have many names for it.
[[nodiscard]] int local_rank();

/// The MPI library's name, or "no MPI" in a build without one.
[[nodiscard]] std::string rank_library();

/// Starts Kokkos on the other ranks and lets them choose their lanes; later calls do nothing. Ranks may take unlike
/// instruction sets, because all sets give the same bits.
/// @param threads number of threads of each rank; with 0 each rank chooses its own
/// @param isa set of the lanes of each rank; without a value each rank chooses its own
/// @throws kernels::UnusableLanes where a rank cannot take the set
void start_ranks(int threads, InstructionSetChoice isa);

/// The RVEs of a mix of packings, spread over the ranks in proportion to their threads. They answer bit for bit as one
/// pool on one rank does. To be called after start_ranks, and only where rank_count() > 1. `note` receives lines for
/// the log: on which ranks the RVEs are and, at the end, how much time the spreading took.
[[nodiscard]] std::unique_ptr<fem::MaterialBatch> make_rank_pool(PackingMix mix, const PoolOptions& options,
                                                                 PackingNote note);

}  // namespace voussoir::host
