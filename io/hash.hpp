#pragma once
/// FNV-1a, 64 bit (Fowler, Noll, Vo): fingerprints of cases and recipes. It offers no security.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>

namespace voussoir::io {

inline constexpr std::uint64_t fnv_start = 14695981039346656037ULL;

/// Hash of `bytes`, continued from `hash`.
[[nodiscard]] inline std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t hash = fnv_start) {
  for (const std::byte b : bytes) {
    hash = (hash ^ std::to_integer<std::uint64_t>(b)) * 1099511628211ULL;
  }
  return hash;
}

/// Hash of a text as 16 hex digits.
[[nodiscard]] inline std::string fingerprint_of(std::string_view text) {
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx",
                static_cast<unsigned long long>(fnv1a(std::as_bytes(std::span(text.data(), text.size())))));
  return digits;
}

}  // namespace voussoir::io
