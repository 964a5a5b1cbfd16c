#pragma once
/// Checksum of a checkpoint: FNV-1a's recurrence on words of eight bytes instead of single bytes. After each product
/// the upper half of the sum is folded into the lower half, since a product alone never carries bits downwards. A
/// checkpoint may have hundreds of megabytes an increment, and words are eight times as fast as bytes.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "io/hash.hpp"

namespace voussoir::io {

/// Bytes may be added in pieces; the checksum depends only on their whole sequence.
class Checksum {
 public:
  void add(std::span<const std::byte> bytes) {
    length_ += bytes.size();
    for (; filled_ > 0 && !bytes.empty(); bytes = bytes.subspan(1)) put(bytes.front());
    for (; bytes.size() >= sizeof(std::uint64_t); bytes = bytes.subspan(sizeof(std::uint64_t))) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data(), sizeof word);
      mix(word);
    }
    for (const std::byte b : bytes) put(b);
  }

  [[nodiscard]] std::uint64_t value() const {
    Checksum end = *this;
    end.mix(word_);
    end.mix(length_);
    return end.sum_;
  }

 private:
  void mix(std::uint64_t word) {
    sum_ = (sum_ ^ word) * 1099511628211ULL;
    sum_ ^= sum_ >> 32;
  }
  void put(std::byte b) {
    word_ |= std::to_integer<std::uint64_t>(b) << (8 * filled_);
    if (++filled_ < sizeof(std::uint64_t)) return;
    mix(word_);
    word_ = 0;
    filled_ = 0;
  }

  std::uint64_t sum_ = fnv_start;
  std::uint64_t word_ = 0;  ///< of bytes that fill no whole word yet
  std::uint64_t length_ = 0;
  unsigned filled_ = 0;
};

}  // namespace voussoir::io
