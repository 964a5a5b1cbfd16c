#include "host/material/state_records.hpp"

#include <stdexcept>

#include <string>

#include "io/byte_stream.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {

namespace {

/// The first number of a state. Version 2 and older began with the number of RVEs, which is never as large.
constexpr std::uint64_t marked_version = 0x766f757373000000U + record_version;

[[noreturn]] void refuse(const char* key, const std::string& sentence) {
  throw io::InputError("--resume", key, sentence);
}

}  // namespace

void write_head(std::vector<std::byte>& bytes, std::uint64_t identity, std::size_t n) {
  io::ByteWriter write(bytes);
  write.value(marked_version);
  write.value(static_cast<std::uint64_t>(n));
  write.value(identity);
}

std::vector<std::byte> join_state(std::uint64_t identity, std::span<const StateRecord> records) {
  std::size_t size = 3 * sizeof(std::uint64_t);
  for (const StateRecord& record : records) size += sizeof(std::uint64_t) + record.size();
  std::vector<std::byte> bytes;
  bytes.reserve(size);
  write_head(bytes, identity, records.size());
  io::ByteWriter write(bytes);
  for (const StateRecord& record : records) write.list(record);
  return bytes;
}

std::vector<StateRecord> split_state(std::span<const std::byte> bytes, std::uint64_t identity, std::size_t n) {
  io::ByteReader read(bytes, not_of_this_case);
  if (read.value<std::uint64_t>() != marked_version) {
    refuse("checkpoint",
           "was written by another version of this program, whose records of RVEs differ from those of "
           "version " +
               std::to_string(record_version) + ": begin the run anew");
  }
  const auto stored = read.value<std::uint64_t>();
  if (stored != n) {
    refuse("mesh", "this case has " + std::to_string(n) +
                       " Gauss points, the checkpoint was made with another number "
                       "of RVEs, " +
                       std::to_string(stored));
  }
  if (read.value<std::uint64_t>() != identity) {
    refuse("packing",
           "the checkpoint's RVEs are made of another packing than the one that packing.folder holds or this "
           "machine chooses: take the folder of packings along with the run");
  }
  std::vector<StateRecord> records(n);
  for (StateRecord& record : records) record = read.take(read.value<std::uint64_t>());
  if (!read.at_end()) throw std::runtime_error(not_of_this_case);
  return records;
}

}  // namespace voussoir::host
