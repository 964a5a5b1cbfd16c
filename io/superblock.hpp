#pragma once
/// The checksum of an HDF5 file's first block. H5Fget_file_image clears the flag "open for writing" in this block but
/// leaves the checksum that the block had with the flag; no reader accepts such a file.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace voussoir::io {

/// Bob Jenkins' lookup3 with the start value 0, as HDF5 has it for all metadata. The words are little endian, as those
/// of the processors that the program runs on.
[[nodiscard]] inline std::uint32_t lookup3(std::span<const std::byte> bytes) {
  std::array<std::uint32_t, 3> s{};
  auto& [a, b, c] = s;
  s.fill(0xdeadbeefU + static_cast<std::uint32_t>(bytes.size()));
  const auto add = [&s](std::span<const std::byte> part) {
    std::array<std::uint32_t, 3> words{};
    std::memcpy(words.data(), part.data(), part.size());
    for (std::size_t k = 0; k < s.size(); ++k) s[k] += words[k];
  };
  const auto mix = [](std::uint32_t& x, const std::uint32_t y, std::uint32_t& z, int turn) {  // z is added to
                                                                                              // afterwards
    x = (x - z) ^ std::rotl(z, turn);
    z += y;
  };
  const auto end = [](std::uint32_t& x, std::uint32_t y, int turn) { x = (x ^ y) - std::rotl(y, turn); };
  constexpr std::size_t round = 12;
  for (; bytes.size() > round; bytes = bytes.subspan(round)) {
    add(bytes.first(round));
    mix(a, b, c, 4), mix(b, c, a, 6), mix(c, a, b, 8), mix(a, b, c, 16), mix(b, c, a, 19), mix(c, a, b, 4);
  }
  add(bytes);
  end(c, b, 14), end(a, c, 11), end(b, a, 25), end(c, b, 16), end(a, c, 4), end(b, a, 14), end(c, b, 24);
  return c;
}

/// Renews the checksum of a first block of version 2 or 3, whose addresses have 8 bytes.
inline void renew_superblock_checksum(std::span<std::byte> image) {
  constexpr std::size_t version = 8, sum_at = 44;
  if (image.size() < sum_at + sizeof(std::uint32_t) || image[version] < std::byte{2}) return;
  const std::uint32_t sum = lookup3(image.first(sum_at));
  std::memcpy(image.data() + sum_at, &sum, sizeof sum);
}

}  // namespace voussoir::io
