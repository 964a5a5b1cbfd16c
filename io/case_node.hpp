#pragma once
/// The tree behind a case file: what the user wrote, where it stands, and the values that were read. Private to io.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/key.hpp"
#include "io/key_info.hpp"

namespace voussoir::io {

struct CaseNode {
  enum class Kind { absent, boolean, integer, number, text, array, table, other };

  std::string name;                   ///< last part of the key; "[2]" in an array
  std::string key;                    ///< full key, e.g. "stage[2].steps"
  std::string place;                  ///< "case.toml:12", "--set", or the place of the table that lacks the key
  std::filesystem::path folder = {};  ///< folder to which a path written here is relative
  Kind kind = Kind::absent;
  std::variant<std::monostate, bool, std::int64_t, double, std::string> value = {};
  std::vector<std::unique_ptr<CaseNode>> children = {};
  bool written = false;              ///< the user wrote it; otherwise the default holds
  bool read = false;                 ///< the program has read it, so that the key is a known one
  std::string resolved = {};         ///< value as TOML, once read
  std::string meaning = {};          ///< value in SI, the same however it was written; the fingerprint is made of these
  std::string idle = {};             ///< why the key does not count in this case; empty where it counts
  std::optional<KeyInfo> info = {};  ///< type and limits, once read
  std::string origin = {};           ///< from where the value was taken over; empty where it is the table's own
  std::string placeholder = {};      ///< stands for the name in lists of keys, where the user has chosen the name

  [[nodiscard]] CaseNode* find(std::string_view child_name);
  CaseNode& add(std::string child_name, std::string child_place);
};

struct CaseState {
  std::filesystem::path path;
  CaseNode root;
};

/// The key `extends`, which is used up while the file is read.
inline constexpr Key extends_key{"extends",
                                 "Another file of the same sort, or an array of such files, whose keys this file takes "
                                 "over. A path that does not begin with / counts from the folder of this file. Where "
                                 "several of these files have one key, the value of the file that is named "
                                 "last holds; a value that stands in this file overrides them all. An array is taken "
                                 "over or replaced as a whole."};

/// Reads the file over the files that it extends, and applies the overrides. Throws InputError.
[[nodiscard]] std::shared_ptr<CaseState> parse_case(const std::filesystem::path& path,
                                                    const std::vector<std::string>& overrides);

/// The same for a text in place of a file; `name` stands for the file in messages. Throws InputError.
[[nodiscard]] std::shared_ptr<CaseState> parse_case_text(const std::string& text, const std::string& name);

/// Reads the files that a node names under `extends`, as if a file extended them. `folder_of_case` is the one to which
/// names given with --set are relative. Throws InputError.
[[nodiscard]] std::shared_ptr<CaseState> parse_extended(const CaseNode& node,
                                                        const std::filesystem::path& folder_of_case);

/// "a number", "a table", ... for messages.
[[nodiscard]] std::string_view kind_name(CaseNode::Kind kind);

/// Text in quotes, escaped as TOML wants it.
[[nodiscard]] std::string toml_text(std::string_view text);

}  // namespace voussoir::io
