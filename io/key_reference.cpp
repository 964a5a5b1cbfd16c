#include "io/key_reference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace voussoir::io {
namespace {

void join(std::vector<ListedKey>& all, const std::vector<KeyInfo>& keys, const std::string& kind) {
  for (const KeyInfo& info : keys) {
    const auto known = std::find_if(all.begin(), all.end(),
                                    [&](const ListedKey& listed) { return listed.info.key == info.key; });
    if (known == all.end()) {
      all.push_back({.info = info, .kinds = {kind}});
      continue;
    }
    if (known->info != info) throw std::logic_error("two kinds say different things of the key " + info.key);
    known->kinds.push_back(kind);
  }
}

/// Where the last part of a key begins. A placeholder in quotes may have dots of its own.
std::size_t begin_of_last(const std::string& key) {
  const std::size_t end = key.ends_with('"') ? key.rfind('"', key.size() - 2) : key.size();
  const std::size_t dot = key.rfind('.', end == std::string::npos ? key.size() : end);
  return dot == std::string::npos ? 0 : dot + 1;
}

}  // namespace

KeyReference join_kinds(std::string title, const std::vector<std::pair<std::string, KeyList>>& kinds) {
  KeyReference reference{.title = std::move(title), .kinds = {}, .tables = {}, .keys = {}};
  for (const auto& [kind, list] : kinds) {
    reference.kinds.push_back(kind);
    join(reference.tables, list.tables, kind);
    join(reference.keys, list.keys, kind);
  }
  return reference;
}

std::string parent_of(const std::string& key) {
  const std::size_t begin = begin_of_last(key);
  return begin == 0 ? "" : key.substr(0, begin - 1);
}

std::string last_part(const std::string& key) { return key.substr(begin_of_last(key)); }

std::string as_parent(const KeyInfo& table) { return table.key + (table.list ? "[]" : ""); }

namespace {

/// Without "[]" and "[2]", and without brackets around a table's name.
std::string without_brackets(const std::string& name) {
  std::string plain;
  bool inside = false;
  for (std::size_t k = 0; k < name.size(); ++k) {
    const bool opens_entry = name[k] == '[' && !plain.empty();
    inside = (inside || opens_entry) && name[k] != ']';
    if (!inside && name[k] != '[' && name[k] != ']') plain += name[k];
  }
  return plain;
}

bool is_part_of(const std::string& key, const std::string& name) {
  const std::string plain = without_brackets(key);
  return plain == name || plain.starts_with(name + ".");
}

}  // namespace

KeyReference part_named(const KeyReference& reference, const std::string& name) {
  const std::string wanted = without_brackets(name);
  KeyReference part{.title = reference.title, .kinds = reference.kinds, .tables = {}, .keys = {}};
  for (const ListedKey& key : reference.keys) {
    if (is_part_of(key.info.key, wanted)) part.keys.push_back(key);
  }
  for (const ListedKey& table : reference.tables) {
    const bool has_keys = std::any_of(part.keys.begin(), part.keys.end(), [&](const ListedKey& key) {
      return parent_of(key.info.key) == as_parent(table.info);
    });
    if (has_keys) part.tables.push_back(table);
  }
  return part;
}

std::vector<std::string> plain_names(const KeyReference& reference) {
  std::vector<std::string> names;
  for (const auto* list : {&reference.tables, &reference.keys}) {
    for (const ListedKey& listed : *list) names.push_back(without_brackets(listed.info.key));
  }
  return names;
}

std::string key_table(const std::vector<KeyReference>& references) {
  std::string out = fmt::format("{},kinds\n", key_table_heading);
  for (const KeyReference& reference : references) {
    for (const ListedKey& listed : reference.keys)
      out += fmt::format("{},{}\n", key_table_line(listed.info), fmt::join(listed.kinds, "|"));
  }
  return out;
}

}  // namespace voussoir::io
