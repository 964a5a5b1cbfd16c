#pragma once
/// Text files that a user gives: case files, sweeps, packings of other codes. A file that is no text in UTF-8 is
/// refused with a sentence that says what it is instead.

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace voussoir::io {

/// A file that cannot be read as text. The message is a sentence without the name of the file; `line` is the line of
/// the fault, or 0 where the fault is one of the whole file.
struct TextFileError : std::runtime_error {
  explicit TextFileError(const std::string& sentence, std::size_t at = 0) : std::runtime_error(sentence), line(at) {}
  std::size_t line;
};

/// The text of a file without a byte-order mark of UTF-8. Throws TextFileError where the file is missing, is no regular
/// file (a pipe would be waited for, and could not be read a second time), cannot be opened, is empty, is larger than
/// `most_bytes`, or is not text in UTF-8.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path, std::size_t most_bytes);

/// What is wrong with a path that is no regular file that can be read ("does not exist"); empty where it is one.
[[nodiscard]] std::string file_fault(const std::filesystem::path& path);

/// The place of the first byte that does not belong to UTF-8; npos where the whole text is UTF-8.
[[nodiscard]] std::size_t find_wrong_utf8(std::string_view text);

/// A text as part of a message of one line: control characters are written as escapes, and a text of more than `most`
/// bytes is cut.
[[nodiscard]] std::string in_one_line(std::string_view text, std::size_t most = 200);

}  // namespace voussoir::io
