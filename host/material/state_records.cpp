#include "host/material/state_records.hpp"

#include <stdexcept>

#include <string>

#include "io/byte_stream.hpp"
#include "io/checksum.hpp"
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

RecordHead head_of(StateRecord record) {
  io::Checksum sum;
  sum.add(record);
  return {record.size(), sum.value()};
}

std::vector<std::byte> join_state(std::uint64_t identity, std::span<const StateRecord> records) {
  std::size_t size = 3 * sizeof(std::uint64_t);
  for (const StateRecord& record : records) size += sizeof(RecordHead) + record.size();
  std::vector<std::byte> bytes;
  bytes.reserve(size);
  write_head(bytes, identity, records.size());
  io::ByteWriter write(bytes);
  for (const StateRecord& record : records) {
    write.value(head_of(record));
    write(record.data(), record.size());
  }
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
  for (std::size_t k = 0; k < n; ++k) {
    const auto head = read.value<RecordHead>();
    records[k] = read.take(head[0]);
    if (head_of(records[k]) != head)
      throw std::runtime_error("the state of RVE " + std::to_string(k) + " is damaged: its checksum is wrong");
  }
  if (!read.at_end()) throw std::runtime_error(not_of_this_case);
  return records;
}

}  // namespace voussoir::host
