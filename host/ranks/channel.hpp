#pragma once
/// Messages between the ranks of a run; the only code that calls MPI. Messages may have any size. A failure of MPI ends
/// all ranks; no function here returns an error.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace voussoir::host {

using Message = std::vector<std::byte>;

/// Starts MPI if the environment says that a launcher has started several processes; otherwise does nothing.
void open_channel();
void close_channel();

[[nodiscard]] int this_rank();
[[nodiscard]] std::string host_name();

void send_message(int rank, std::span<const std::byte> message);

/// Waits for the next message of a rank. The wait is busy for half a millisecond; later it sleeps between two looks, so
/// that a rank without work takes no core from a rank with work.
[[nodiscard]] Message receive_message(int rank);

/// Ends all ranks at once with this exit code. It is called where a failure can no longer be reported in a reply.
[[noreturn]] void abort_ranks(int exit_code, const char* sentence);

}  // namespace voussoir::host
