#include "host/ranks/session.hpp"

#include <Kokkos_Core.hpp>
#include <stdexcept>

#include "host/process/build_info.hpp"
#include "host/ranks/messages.hpp"
#include "host/ranks/pool.hpp"

namespace voussoir::host {
namespace {

std::vector<RankInfo>& ranks() {
  static std::vector<RankInfo> all;
  return all;
}

}  // namespace

RankSession::RankSession() { open_channel(); }

RankSession::~RankSession() {
  if (!serves()) {
    for (int r = 1; r < rank_count(); ++r) send_message(r, message_of(Command::quit));
  }
  close_channel();
}

bool RankSession::serves() const { return this_rank() != 0; }

void start_ranks(int threads) {
  if (rank_count() == 1 || !ranks().empty()) return;
  std::vector<RankInfo> found{{host_name(), Kokkos::DefaultHostExecutionSpace().concurrency()}};
  Message message = message_of(Command::start);
  ByteWriter write(message);
  write.list(std::string(build_revision));
  write.value(threads);
  for (int r = 1; r < rank_count(); ++r) send_message(r, message);
  std::string refusal;
  for (int r = 1; r < rank_count(); ++r) {
    const Message reply = receive_message(r);
    ByteReader read(reply);
    const bool good = read.value<bool>();
    RankInfo info{read.text(), 1};
    if (good) info.threads = read.value<int>();
    if (!good && refusal.empty()) refusal = info.host;
    found.push_back(std::move(info));
  }
  if (!refusal.empty()) throw std::runtime_error(refusal);
  ranks() = std::move(found);
}

std::unique_ptr<fem::MaterialBatch> make_rank_pool(PackedRve rve, const PoolOptions& options, std::size_t n,
                                                   PackingNote note) {
  return std::make_unique<RankPool>(std::move(rve), options, n, ranks(), std::move(note));
}

}  // namespace voussoir::host
