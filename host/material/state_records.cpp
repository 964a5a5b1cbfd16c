#include "host/material/state_records.hpp"

#include <stdexcept>

#include "io/byte_stream.hpp"

namespace voussoir::host {

std::vector<std::byte> join_state(std::uint64_t identity, std::span<const StateRecord> records) {
  std::size_t size = 2 * sizeof(std::uint64_t);
  for (const StateRecord& record : records) size += sizeof(std::uint64_t) + record.size();
  std::vector<std::byte> bytes;
  bytes.reserve(size);
  io::ByteWriter write(bytes);
  write.value(static_cast<std::uint64_t>(records.size()));
  write.value(identity);
  for (const StateRecord& record : records) write.list(record);
  return bytes;
}

std::vector<StateRecord> split_state(std::span<const std::byte> bytes, std::uint64_t identity, std::size_t n) {
  io::ByteReader read(bytes, not_of_this_case);
  if (read.value<std::uint64_t>() != n) throw std::runtime_error("the checkpoint has another number of RVEs");
  if (read.value<std::uint64_t>() != identity)
    throw std::runtime_error("the checkpoint's RVEs are made of another packing");
  std::vector<StateRecord> records(n);
  for (StateRecord& record : records) record = read.take(read.value<std::uint64_t>());
  if (!read.at_end()) throw std::runtime_error(not_of_this_case);
  return records;
}

}  // namespace voussoir::host
