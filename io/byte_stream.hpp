#pragma once
/// Numbers to bytes and back, bit for bit and without padding, for checkpoints of RVEs and for messages between
/// processes of one build.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace voussoir::io {

class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {}

  template <class T>
  void operator()(const T* from, std::size_t n) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (n == 0) return;
    const std::size_t at = bytes_.size();
    bytes_.resize(at + n * sizeof(T));
    std::memcpy(bytes_.data() + at, from, n * sizeof(T));
  }
  template <class T>
  void value(const T& v) {
    (*this)(&v, 1);
  }
  /// Writes the number of values before the values.
  template <class List>
  void list(const List& values) {
    value(static_cast<std::uint64_t>(values.size()));
    (*this)(values.data(), values.size());
  }

 private:
  std::vector<std::byte>& bytes_;
};

class ByteReader {
 public:
  /// @param complaint message of the std::runtime_error that is thrown where the bytes end too early
  explicit ByteReader(std::span<const std::byte> bytes,
                      const char* complaint = "the bytes end before the last value that is read from them")
      : bytes_(bytes), complaint_(complaint) {}

  template <class T>
  void operator()(T* to, std::size_t n) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::span<const std::byte> from = take(n, sizeof(T));
    if (!from.empty()) std::memcpy(to, from.data(), from.size());
  }
  template <class T>
  [[nodiscard]] T value() {
    T v{};
    (*this)(&v, 1);
    return v;
  }
  template <class T>
  [[nodiscard]] std::vector<T> list() {
    const auto n = value<std::uint64_t>();
    const std::span<const std::byte> from = take(n, sizeof(T));
    std::vector<T> values(n);
    if (!from.empty()) std::memcpy(values.data(), from.data(), from.size());
    return values;
  }
  [[nodiscard]] std::string text() {
    const std::vector<char> letters = list<char>();
    return {letters.begin(), letters.end()};
  }
  /// The bytes of the next `n` values of `size` bytes each, without a copy.
  [[nodiscard]] std::span<const std::byte> take(std::uint64_t n, std::size_t size = 1) {
    if (n > bytes_.size() / size) throw std::runtime_error(complaint_);
    const std::span<const std::byte> piece = bytes_.first(n * size);
    bytes_ = bytes_.subspan(n * size);
    return piece;
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
  const char* complaint_;
};

}  // namespace voussoir::io
