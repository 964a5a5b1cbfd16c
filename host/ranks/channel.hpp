#pragma once
/// Messages between the ranks of a run: the only code that knows MPI. Messages may have any size. A failure of MPI ends
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

/// Waits for the next message of a rank. It spins for half a millisecond and sleeps between looks from then on, so that
/// a rank without work takes no core from a rank that has some.
[[nodiscard]] Message receive_message(int rank);

/// Ends all ranks at once with this exit code, where a failure can no longer be reported in a reply.
[[noreturn]] void abort_ranks(int exit_code, const char* sentence);

}  // namespace voussoir::host
