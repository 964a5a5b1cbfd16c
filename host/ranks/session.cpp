#include "host/ranks/session.hpp"

#include <Kokkos_Core.hpp>
#include <stdexcept>

#include "host/process/build_info.hpp"
#include "host/ranks/messages.hpp"
#include "host/ranks/pool.hpp"
#include "kernels/isa/choose_lanes.hpp"

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

void start_ranks(int threads, InstructionSetChoice isa) {
  if (rank_count() == 1 || !ranks().empty()) return;
  std::vector<RankInfo> found{{host_name(), Kokkos::DefaultHostExecutionSpace().concurrency(),
                               kernels::name_of(kernels::chosen_lanes().lanes->isa)}};
  Message message = message_of(Command::start);
  ByteWriter write(message);
  write.list(std::string(build_revision));
  write.value(threads);
  write.list(std::string(isa ? kernels::name_of(*isa) : ""));
  for (int r = 1; r < rank_count(); ++r) send_message(r, message);
  std::string refusal, fault;
  for (int r = 1; r < rank_count(); ++r) {
    const Message reply = receive_message(r);
    ByteReader read(reply);
    const bool good = read.value<bool>();
    RankInfo info{read.text(), 1};
    if (good) {
      info.threads = read.value<int>();
      info.lanes = read.text();
      if (const std::string theirs = read.text(); !theirs.empty() && fault.empty())
        fault = "rank " + std::to_string(r) + " on " + info.host + ": " + theirs;
    }
    if (!good && refusal.empty()) refusal = info.host;
    found.push_back(std::move(info));
  }
  if (!refusal.empty()) throw std::runtime_error(refusal);
  if (!fault.empty()) throw kernels::UnusableLanes(fault);
  ranks() = std::move(found);
}

std::unique_ptr<fem::MaterialBatch> make_rank_pool(PackingMix mix, const PoolOptions& options, PackingNote note) {
  return std::make_unique<RankPool>(std::move(mix), options, ranks(), std::move(note));
}

}  // namespace voussoir::host
