#pragma once
/// The committed state of a pool as bytes: number of RVEs, their identity, then one record an RVE after its length, in
/// the order of the Gauss points. A pool whose RVEs are spread over processes has the bytes of one that is not.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voussoir::host {

using StateRecord = std::span<const std::byte>;

inline constexpr const char* not_of_this_case = "the checkpoint's RVEs are not those of this case";

/// @param identity of the packings that the RVEs are made of: their states mean nothing without these
[[nodiscard]] std::vector<std::byte> join_state(std::uint64_t identity, std::span<const StateRecord> records);

/// The records where they lie in `bytes`. Throws std::runtime_error unless there are `n` of this identity.
[[nodiscard]] std::vector<StateRecord> split_state(std::span<const std::byte> bytes, std::uint64_t identity,
                                                   std::size_t n);

}  // namespace voussoir::host
