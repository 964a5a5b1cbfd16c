#pragma once
/// What is known of a key of a case file once it has been read: for lists of all keys, and for tests of their limits.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "io/units.hpp"

namespace voussoir::io {

enum class KeyType { quantity, integer, boolean, text, choice, path };

struct KeyInfo {
  std::string key = {};  ///< full name; "soil.class[].size_to" stands for the key of every entry
  KeyType type = KeyType::text;
  bool list = false;                      ///< an array of such values
  Dimension dimension = Dimension::none;  ///< of a quantity
  std::string fallback = {};              ///< the default as TOML; empty where the key must be given or may be left out
  bool required = false;
  std::string at_least = {}, at_most = {};  ///< limits that still hold, written as in a case file; empty where there is
                                            ///< none
  bool above_zero = false;                  ///< 0 is no value of the key
  std::size_t most_entries = 0;             ///< of a list
  std::vector<std::string> choices = {};    ///< of a choice
};

/// "quantity", "integer", ...
[[nodiscard]] std::string_view name_of(KeyType type);

/// The keys as a table of comma-separated values with one key a line:
/// key,type,dimension,default,at_least,at_most,choices. In "at_least", "> 0" says that the key must be positive.
[[nodiscard]] std::string key_table(const std::vector<KeyInfo>& keys);

}  // namespace voussoir::io
