#include "io/input_error.hpp"

#include <fmt/format.h>

namespace voussoir::io {

namespace {

std::string one_line(const std::string& place, const std::string& key, const std::string& sentence) {
  const std::string separator = place == "--set" ? " " : ": ";
  return key.empty() ? fmt::format("{}: {}", place, sentence)
                     : fmt::format("{}{}{}: {}", place, separator, key, sentence);
}

}  // namespace

InputError::InputError(const std::string& place, const std::string& key, const std::string& sentence)
    : std::runtime_error(one_line(place, key, sentence)) {}

}  // namespace voussoir::io
