#include "io/input_error.hpp"

#include <fmt/format.h>

#include "io/text_file.hpp"

namespace voussoir::io {

namespace {

std::string one_line(const std::string& place, const std::string& key, const std::string& sentence) {
  const std::string separator = place == "--set" ? " " : ": ";
  return key.empty() ? fmt::format("{}: {}", in_one_line(place), sentence)
                     : fmt::format("{}{}{}: {}", in_one_line(place), separator, in_one_line(key), sentence);
}

}  // namespace

InputError::InputError(const std::string& place, const std::string& key, const std::string& sentence)
    : std::runtime_error(one_line(place, key, sentence)), place_(place), key_(key), sentence_(sentence) {}

}  // namespace voussoir::io
