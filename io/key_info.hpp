#pragma once
/// What is known of a key of a case file once it has been read: for lists of all keys, and for tests of their limits.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "io/units.hpp"

namespace voussoir::io {

enum class KeyType {
  quantity,
  integer,
  boolean,
  text,
  choice,
  path,
  place,  ///< the name of a point, or two lengths
  value,  ///< any number, text, boolean or array of these, which is handed on as it is written
  list_of_text,
  table
};

struct KeyInfo {
  std::string key = {};  ///< full name; "soil.class[].size_to" stands for the key of every entry
  KeyType type = KeyType::text;
  bool list = false;                      ///< an array of such values
  bool or_one = false;                    ///< one such value may stand in place of the array
  Dimension dimension = Dimension::none;  ///< of a quantity
  std::string fallback = {};              ///< the default as TOML; empty where the key must be given or may be left out
  std::string default_words = {};         ///< the default in words, where it follows from other keys
  bool required = false;
  std::string at_least = {}, at_most = {};  ///< limits that still hold, written as in a case file; empty where there is
                                            ///< none
  bool above_zero = false;                  ///< 0 is no value of the key
  std::size_t least_entries = 0;            ///< of a list
  std::size_t most_entries = 0;             ///< of a list
  bool different = false;                   ///< no two entries of a list are the same
  std::vector<std::string> choices = {};    ///< of a choice
  std::string pattern = {};                 ///< regular expression that a text matches whole; empty: any text
  std::string help = {};                    ///< the sentences that explain the key
  std::string like = {};                    ///< a key that is the same elsewhere, in whose place a page names its table
  bool named_by_user = false;               ///< `key` ends in a placeholder, for which the user chooses the name

  [[nodiscard]] bool operator==(const KeyInfo& other) const = default;
};

/// The keys and the tables of a file.
struct KeyList {
  std::vector<KeyInfo> keys;
  std::vector<KeyInfo> tables;
};

/// "quantity", "integer", ...
[[nodiscard]] std::string_view name_of(KeyType type);

/// A default without the quotes of TOML.
[[nodiscard]] std::string without_quotes(const std::string& as_toml);

/// The heading of a table of comma-separated values with one key a line, and the line of a key. In "at_least", "> 0"
/// says that the key must be positive.
inline constexpr std::string_view key_table_heading = "key,type,dimension,default,at_least,at_most,choices,help";
[[nodiscard]] std::string key_table_line(const KeyInfo& info);

/// Text as a field of comma-separated values.
[[nodiscard]] std::string csv_field(const std::string& text);

}  // namespace voussoir::io
