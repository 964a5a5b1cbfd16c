#pragma once
/// Messages between the ranks of a run: the only code that knows MPI. Sizes are free; nothing here fails but by ending
/// all ranks.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace voussoir::host {

using Message = std::vector<std::byte>;

/// Starts MPI where the environment says that a launcher has started several processes; a plain start costs nothing.
void open_channel();
void close_channel();

[[nodiscard]] int this_rank();
[[nodiscard]] std::string host_name();

void send_message(int rank, std::span<const std::byte> message);

/// Waits for the next message of a rank: awake for half a millisecond, then asleep between looks, so that a rank
/// without work takes no core from one that has some.
[[nodiscard]] Message receive_message(int rank);

/// Ends all ranks at once with this exit code: for what cannot be answered any more.
[[noreturn]] void abort_ranks(int exit_code, const char* sentence);

}  // namespace voussoir::host
