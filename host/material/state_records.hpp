#pragma once
/// The committed state of a pool as bytes: the version of the records, the number of RVEs, the identity of their
/// packings, then the length, the checksum and the record of each RVE in the order of the Gauss points. A pool whose
/// RVEs are spread over processes has the same bytes as a pool in one process.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voussoir::host {

using StateRecord = std::span<const std::byte>;

inline constexpr const char* not_of_this_case = "the checkpoint's RVEs are not those of this case";

/// Version of the records; it must be raised when the meaning of their bytes changes. Version 3 had no checksums. It is
/// refused, because a change of its numbers could not be seen.
inline constexpr std::uint64_t record_version = 4;

/// The bytes before the first record.
void write_head(std::vector<std::byte>& bytes, std::uint64_t identity, std::size_t n);

/// The numbers before a record: its length [bytes] and its checksum (io/checksum.hpp), from which a change of any one
/// bit is seen.
using RecordHead = std::array<std::uint64_t, 2>;
[[nodiscard]] RecordHead head_of(StateRecord record);

/// @param identity a hash of the packings that the RVEs are made of; the states have no meaning with other packings
[[nodiscard]] std::vector<std::byte> join_state(std::uint64_t identity, std::span<const StateRecord> records);

/// The records, as parts of `bytes`. Throws io::InputError where they are of another version of this program, or unless
/// there are `n` records and this is their identity; std::runtime_error where the bytes are no state, or are damaged.
[[nodiscard]] std::vector<StateRecord> split_state(std::span<const std::byte> bytes, std::uint64_t identity,
                                                   std::size_t n);

}  // namespace voussoir::host
