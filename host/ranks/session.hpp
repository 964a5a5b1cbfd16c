#pragma once
/// More than one process: under a launcher such as mpirun the RVEs of a mesh are spread over its ranks, and everything
/// else (case, mesh, Newton, files, log) stays on the first. The first rank talks, the others only answer, so that no
/// rank can wait for a message that does not come. A build without MPI has these functions too (ranks_none.cpp): one
/// rank, no pool of ranks.

#include <memory>
#include <string>

#include "host/packing/packings.hpp"

namespace voussoir::fem {
class MaterialBatch;
}

namespace voussoir::host {

struct PoolOptions;

/// The frame of `main`. MPI is started only where a launcher's environment says that there may be other ranks.
class RankSession {
 public:
  RankSession();
  ~RankSession();  ///< on the first rank: tells the others to end
  RankSession(const RankSession&) = delete;
  RankSession& operator=(const RankSession&) = delete;

  [[nodiscard]] bool serves() const;  ///< not the first rank: has nothing to do but `serve`
  /// Answers the first rank until that ends, whatever for; then 0, since the first rank's exit code says how the run
  /// ended. Ctrl-C, SIGTERM and SIGUSR1 are the first rank's to obey.
  [[nodiscard]] int serve() const;
};

[[nodiscard]] int rank_count();

/// The MPI library's name; "no MPI" in a build without.
[[nodiscard]] std::string rank_library();

/// Starts Kokkos on the other ranks, once. @param threads of each rank; 0: its own choice
void start_ranks(int threads);

/// `n` clones of `rve`, spread over the ranks as their threads can carry them; they answer bit for bit as one pool
/// does. For rank_count() > 1, after start_ranks. `note` is told where they are and, at the end, what the spreading
/// cost.
[[nodiscard]] std::unique_ptr<fem::MaterialBatch> make_rank_pool(PackedRve rve, const PoolOptions& options,
                                                                 std::size_t n, PackingNote note);

}  // namespace voussoir::host
