#include "host/ranks/channel.hpp"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <thread>

#include "host/process/exit_code.hpp"
#include "host/ranks/session.hpp"

namespace voussoir::host {
namespace {

constexpr std::size_t piece = std::size_t{1} << 24;  ///< bytes of one MPI message, whose length MPI takes as an int
constexpr auto patience = std::chrono::microseconds(500);
constexpr auto nap = std::chrono::microseconds(100);

bool open = false;
int rank_of_machine = 0;  ///< see local_rank

/// True where the environment of a launcher says that there are, or may be, several processes.
bool launched() {
  for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS"}) {
    if (const char* text = std::getenv(size)) return std::atoi(text) > 1;
  }
  return std::getenv("PMIX_RANK") != nullptr || std::getenv("PMI_RANK") != nullptr;
}

void wait_for(MPI_Request& request) {
  const auto since = std::chrono::steady_clock::now();
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
    if (std::chrono::steady_clock::now() - since > patience) std::this_thread::sleep_for(nap);
  }
}

void send_bytes(int rank, const void* bytes, std::size_t n) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Isend(bytes, static_cast<int>(n), MPI_BYTE, rank, 0, MPI_COMM_WORLD, &request);
  wait_for(request);
}  // NOLINT(clang-analyzer-optin.mpi.MPI-Checker): wait_for() waits by MPI_Test, which the check does not know.

void receive_bytes(int rank, void* bytes, std::size_t n) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Irecv(bytes, static_cast<int>(n), MPI_BYTE, rank, 0, MPI_COMM_WORLD, &request);
  wait_for(request);
}  // NOLINT(clang-analyzer-optin.mpi.MPI-Checker): as above.

}  // namespace

void open_channel() {
  if (!launched()) return;
  int granted = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &granted);
  open = true;
  MPI_Comm machine = MPI_COMM_NULL;  // all ranks have to take part, so that it is made now
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, this_rank(), MPI_INFO_NULL, &machine);
  MPI_Comm_rank(machine, &rank_of_machine);
  MPI_Comm_free(&machine);
}

void close_channel() {
  if (open) MPI_Finalize();
  open = false;
}

int this_rank() {
  int rank = 0;
  if (open) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int rank_count() {
  int count = 1;
  if (open) MPI_Comm_size(MPI_COMM_WORLD, &count);
  return count;
}

int local_rank() { return rank_of_machine; }

std::string rank_library() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  MPI_Get_library_version(text.data(), &length);
  const std::string all(text.data(), static_cast<std::size_t>(length));
  return all.substr(0, all.find_first_of(",\n"));
}

std::string host_name() {
  std::array<char, MPI_MAX_PROCESSOR_NAME> text{};
  int length = 0;
  MPI_Get_processor_name(text.data(), &length);
  return {text.data(), static_cast<std::size_t>(length)};
}

void send_message(int rank, std::span<const std::byte> message) {
  const std::uint64_t size = message.size();
  send_bytes(rank, &size, sizeof size);
  for (std::size_t at = 0; at < size; at += piece) send_bytes(rank, message.data() + at, std::min(piece, size - at));
}

Message receive_message(int rank) {
  std::uint64_t size = 0;
  receive_bytes(rank, &size, sizeof size);
  Message message;
  try {
    message.resize(size);
  } catch (const std::bad_alloc&) {
    abort_ranks(exit_code(Outcome::machine_failure), "there is no memory left for a message between ranks");
  }
  for (std::size_t at = 0; at < size; at += piece) receive_bytes(rank, message.data() + at, std::min(piece, size - at));
  return message;
}

void abort_ranks(int exit_code, const char* sentence) {
  std::fprintf(stderr, "voussoir: rank %d on %s: %s\n", this_rank(), host_name().c_str(), sentence);
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::abort();
}

}  // namespace voussoir::host
