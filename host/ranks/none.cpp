// The functions of session.hpp in a build without MPI.
#include <stdexcept>

#include "fem/material_batch.hpp"
#include "host/ranks/session.hpp"

namespace voussoir::host {

RankSession::RankSession() = default;
RankSession::~RankSession() = default;
bool RankSession::serves() const { return false; }
int RankSession::serve() const { return 0; }

int rank_count() { return 1; }
int local_rank() { return 0; }
std::string rank_library() { return "no MPI"; }
void start_ranks(int, InstructionSetChoice) {}

std::unique_ptr<fem::MaterialBatch> make_rank_pool(PackingMix, const PoolOptions&, PackingNote) {
  throw std::logic_error("a build without MPI has no pool of ranks");
}

}  // namespace voussoir::host
