#pragma once
/// All keys of a sort of files, each once, with the kinds that use it; and what is printed of them.

#include <string>
#include <utility>
#include <vector>

#include "io/key_info.hpp"

namespace voussoir::io {

struct ListedKey {
  KeyInfo info;
  std::vector<std::string> kinds;
  std::vector<std::pair<std::string, std::string>> other_defaults = {};  ///< a preset, and the default that it gives
};

struct KeyReference {
  std::string title;               ///< what these files are called, "case"
  std::vector<std::string> kinds;  ///< all of them; one where only its keys are listed; none where files have no kind
  std::vector<ListedKey> tables;
  std::vector<ListedKey> keys;
};

/// Joins the keys of several kinds, (kind, keys) each. Throws std::logic_error where two kinds say different things of
/// one key.
[[nodiscard]] KeyReference join_kinds(std::string title, const std::vector<std::pair<std::string, KeyList>>& kinds);

/// "soil.class[]" and "size_to" of "soil.class[].size_to"; a table that is an array is the parent "soil.class[]" of its
/// keys.
[[nodiscard]] std::string parent_of(const std::string& key);
[[nodiscard]] std::string last_part(const std::string& key);
/// The name of a table as the parent of its keys.
[[nodiscard]] std::string as_parent(const KeyInfo& table);

/// What of a reference belongs to `name`: a key, "soil.thickness", or a table with its keys, "soil", "[soil]",
/// "soil.class" or "soil.class[]". No keys where it has nothing of this name.
[[nodiscard]] KeyReference part_named(const KeyReference& reference, const std::string& name);

/// The names of all keys and tables without the brackets of arrays, "soil.class.size_to".
[[nodiscard]] std::vector<std::string> plain_names(const KeyReference& reference);

/// Comma-separated values with one key a line: key,type,dimension,default,at_least,at_most,choices,help,kinds. In
/// "at_least", "> 0" says that the key must be positive.
[[nodiscard]] std::string key_table(const std::vector<KeyReference>& references);

/// A page in Markdown, which is docs/reference/keys.md where all references are in it.
[[nodiscard]] std::string key_page(const std::vector<KeyReference>& references);
/// The same without the introduction and the tables of units and of kinds, for a part of a reference.
[[nodiscard]] std::string key_sections(const std::vector<KeyReference>& references);

/// A JSON schema (draft 2020-12) for files of this sort, with which editors complete and check them.
[[nodiscard]] std::string key_schema(const KeyReference& reference);

}  // namespace voussoir::io
