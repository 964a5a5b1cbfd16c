#include "io/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <system_error>

#include "io/regular_file.hpp"

namespace voussoir::io {

namespace {

/// The length of the sequence of UTF-8 at the text's beginning; 0 where there is none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80 ? 1 : first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  if (first > 0xF4 || length == 0 || length > text.size()) {
    return 0;
  }
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0) != 0x80) {
      return 0;
    }
  }
  // Overlong forms, halves of surrogate pairs, and code points above the last one.
  const bool wrong = length > 1 && ((first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ||
                                    (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F));
  return wrong ? 0 : length;
}

/// "UTF-16", "UTF-32" or "" by the mark at the file's beginning, or by the zero bytes that ASCII has in these
/// encodings.
std::string_view wide_encoding(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xFF\xFE\0\0"sv) || bytes.starts_with("\0\0\xFE\xFF"sv)) {
    return "UTF-32";
  }
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    return "UTF-16";
  }
  const std::string_view head = bytes.substr(0, 64);
  std::size_t even = 0;
  std::size_t odd = 0;
  for (std::size_t k = 0; k < head.size(); ++k) {
    (k % 2 == 0 ? even : odd) += head[k] == '\0' ? 1U : 0U;
  }
  // Half of the bytes are zero, all of them at odd places, or all of them at even ones.
  const bool halves = head.size() >= 4 && (even == 0 || odd == 0) && 5 * (even + odd) >= 2 * head.size();
  return halves ? "UTF-16" : "";
}

std::size_t line_of(std::string_view text, std::size_t at) {
  return 1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

}  // namespace

std::size_t find_wrong_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = sequence_length(text.substr(at));
    if (length == 0) {
      return at;
    }
    at += length;
  }
  return std::string_view::npos;
}

std::string file_fault(const std::filesystem::path& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  switch (status.type()) {
    case std::filesystem::file_type::regular:
      break;
    case std::filesystem::file_type::not_found:
      return "does not exist";
    case std::filesystem::file_type::directory:
      return "is a folder";
    case std::filesystem::file_type::none:
      return "cannot be looked at (" + failure.message() + ")";
    default:
      return "is a pipe or a device, which could not be read a second time";
  }
  const int file = open_regular(path, O_RDONLY);
  if (file < 0) {
    return "may not be opened";
  }
  ::close(file);
  return "";
}

std::string read_text_file(const std::filesystem::path& path, std::size_t most_bytes) {
  const std::string fault = file_fault(path);
  if (!fault.empty()) {
    throw TextFileError("cannot be read: it " + fault);
  }
  std::ifstream file(path, std::ios::binary);
  std::string text(most_bytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad()) {
    throw TextFileError("cannot be read: the disk gave an error");
  }
  if (text.size() > most_bytes) {
    throw TextFileError(fmt::format("is larger than the {} kB that such a file may have", most_bytes / 1000));
  }
  if (text.empty()) {
    throw TextFileError("is empty");
  }
  if (const auto encoding = wide_encoding(text); !encoding.empty()) {
    throw TextFileError(fmt::format("is text in {}; it must be saved as UTF-8", encoding));
  }
  if (text.starts_with("\xEF\xBB\xBF")) {
    text.erase(0, 3);
  }
  const std::size_t zero = text.find('\0');
  if (zero != std::string::npos) {
    throw TextFileError("is no text: it holds a zero byte", line_of(text, zero));
  }
  const std::size_t wrong = find_wrong_utf8(text);
  if (wrong != std::string::npos) {
    throw TextFileError(
        fmt::format("holds the byte 0x{:02X}, which is no text in UTF-8", static_cast<unsigned char>(text[wrong])),
        line_of(text, wrong));
  }
  return text;
}

std::string in_one_line(std::string_view text, std::size_t most) {
  std::string out;
  for (std::size_t at = 0; at < text.size() && out.size() < most;) {
    const std::size_t length = sequence_length(text.substr(at));
    const auto first = static_cast<unsigned char>(text[at]);
    if (length == 0 || first < 0x20 || first == 0x7F) {
      out += first == '\n' ? "\\n" : fmt::format("\\x{:02X}", first);
      ++at;
    } else {
      out += text.substr(at, length);
      at += length;
    }
    if (out.size() >= most && at < text.size()) {
      out += "...";
    }
  }
  return out;
}

}  // namespace voussoir::io
