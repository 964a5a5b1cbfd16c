#include "io/case_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>
#include <set>

#include "io/case_node.hpp"
#include "io/case_value.hpp"

namespace voussoir::io {

namespace {

using Kind = CaseNode::Kind;

/// Notes what kind of value a key has. `as_toml` is its default; `required` says that it has none and must be given.
KeyInfo& note(CaseNode& node, const Key& key, KeyType type, std::string as_toml = "", bool required = false,
              bool list = false) {
  return node.info.emplace(KeyInfo{.key = node.key,
                                   .type = type,
                                   .list = list,
                                   .fallback = std::move(as_toml),
                                   .required = required,
                                   .help = std::string(key.help)});
}

KeyInfo& with_limits(KeyInfo& info, Dimension dimension, const QuantityRule& rule) {
  info.dimension = dimension;
  info.at_least = rule.at_least.value_or("");
  info.at_most = rule.at_most.value_or("");
  info.above_zero = rule.positive;
  info.default_words = rule.default_words;
  return info;
}

KeyInfo& with_limits(KeyInfo& info, const IntegerRule& rule) {
  if (rule.at_least) {
    info.at_least = fmt::format("{}", *rule.at_least);
  }
  if (rule.at_most) {
    info.at_most = fmt::format("{}", *rule.at_most);
  }
  info.default_words = rule.default_words;
  return info;
}

KeyInfo& with_limits(KeyInfo& info, const ListRule& rule) {
  info.least_entries = rule.least;
  info.most_entries = rule.most;
  info.different = rule.different;
  info.or_one = rule.or_one;
  return info;
}

/// The default of an array as TOML, of which `as_toml` writes an entry.
template <class T, class AsToml>
std::string list_as_toml(const std::optional<std::vector<T>>& fallback, AsToml as_toml) {
  if (!fallback) return "";
  std::vector<std::string> entries;
  for (const T& entry : *fallback) entries.push_back(as_toml(entry));
  return fmt::format("[{}]", fmt::join(entries, ", "));
}

/// Refuses a number of entries that is not within these limits; `limit` is the one that it is beyond.
void refuse_count(const CaseNode& node, const KeyInfo& info, const char* bound, std::size_t limit) {
  fail(node, fmt::format("must have {}{} {}, has {}", info.least_entries == info.most_entries ? "" : bound, limit,
                         limit == 1 ? "entry" : "entries", node.children.size()));
}

/// Reads an array entry by entry: read_one(entry, default of this entry) -> value. `info` is the node's own.
template <class T, class Default, class ReadOne>
std::vector<T> read_array(CaseNode& node, const KeyInfo& info, const std::optional<std::vector<Default>>& fallback,
                          ReadOne read_one) {
  if (info.or_one && node.written && node.kind != Kind::array) return {read_one(node, std::optional<Default>{})};
  if (node.written) {
    expect(node, Kind::array);
    if (node.children.size() > info.most_entries) refuse_count(node, info, "at most ", info.most_entries);
  } else if (node.children.empty()) {
    for (std::size_t i = 0; i < given(fallback).size(); ++i) {
      node.add(fmt::format("[{}]", i), node.place);
    }
  }
  std::vector<T> values;
  std::vector<std::string> texts;
  std::vector<std::string> meanings;
  std::set<std::string> known;
  for (const auto& entry : node.children) {
    entry->read = true;
    values.push_back(read_one(*entry, node.written ? std::optional<Default>{} : given(fallback).at(values.size())));
    texts.push_back(entry->resolved);
    meanings.push_back(entry->meaning);
    if (info.different && !known.insert(entry->meaning).second)
      fail(node, fmt::format("names {} twice", entry->resolved));
  }
  if (node.written && values.size() < info.least_entries) refuse_count(node, info, "at least ", info.least_entries);
  node.resolved = fmt::format("[{}]", fmt::join(texts, ", "));
  node.meaning = fmt::format("[{}]", fmt::join(meanings, ", "));
  return values;
}

void expect_pattern(const CaseNode& node, const std::string& value, const TextRule& rule) {
  if (!rule.pattern.empty() && !std::regex_match(value, std::regex(rule.pattern))) fail(node, rule.fault);
}

}  // namespace

CaseNode* Table::find(std::string_view key) const {
  CaseNode* node = node_->find(key);
  return node != nullptr && node->written ? node : nullptr;
}

std::string Table::full_key(std::string_view key) const {
  if (key.empty()) return node_->key;
  return node_->key.empty() ? std::string(key) : fmt::format("{}.{}", node_->key, key);
}

CaseNode& Table::take(std::string_view key, bool has_fallback) const {
  CaseNode* node = node_->find(key);
  if (node == nullptr) {
    if (!has_fallback) {
      throw error(key, "is missing");
    }
    node = &node_->add(std::string(key), node_->place);
  }
  node->read = true;
  return *node;
}

bool Table::has(std::string_view key) const { return find(key) != nullptr; }

double Table::quantity(const Key& key, Dimension dimension, const QuantityRule& rule) const {
  CaseNode& node = take(key.name, rule.fallback.has_value());
  with_limits(note(node, key, KeyType::quantity, rule.fallback ? quantity_as_toml(*rule.fallback) : "", !rule.fallback),
              dimension, rule);
  return read_quantity(node, dimension, rule, rule.fallback);
}

std::optional<double> Table::optional_quantity(const Key& key, Dimension dimension, const QuantityRule& rule) const {
  CaseNode& node = take(key.name, true);
  with_limits(note(node, key, KeyType::quantity), dimension, rule);
  if (!node.written) return std::nullopt;
  return read_quantity(node, dimension, rule, {});
}

std::int64_t Table::integer(const Key& key, const IntegerRule& rule) const {
  CaseNode& node = take(key.name, rule.fallback.has_value());
  with_limits(note(node, key, KeyType::integer, rule.fallback ? fmt::format("{}", *rule.fallback) : "", !rule.fallback),
              rule);
  return read_integer(node, rule, rule.fallback);
}

std::optional<std::int64_t> Table::optional_integer(const Key& key, const IntegerRule& rule) const {
  CaseNode& node = take(key.name, true);
  with_limits(note(node, key, KeyType::integer), rule);
  if (!node.written) return std::nullopt;
  return read_integer(node, rule, {});
}

bool Table::boolean(const Key& key, std::optional<bool> fallback) const {
  CaseNode& node = take(key.name, fallback.has_value());
  note(node, key, KeyType::boolean, fallback ? (*fallback ? "true" : "false") : "", !fallback);
  if (node.written) {
    expect(node, Kind::boolean);
  }
  const bool value = node.written ? std::get<bool>(node.value) : given(fallback);
  node.resolved = value ? "true" : "false";
  node.meaning = node.resolved;
  return value;
}

std::string Table::text(const Key& key, const std::optional<std::string>& fallback, const TextRule& rule) const {
  CaseNode& node = take(key.name, fallback.has_value());
  KeyInfo& info = note(node, key, KeyType::text, fallback ? toml_text(*fallback) : "", !fallback);
  info.pattern = rule.pattern;
  info.default_words = rule.default_words;
  std::string value = read_text(node, fallback);
  expect_pattern(node, value, rule);
  return value;
}

std::optional<std::string> Table::optional_text(const Key& key, const TextRule& rule) const {
  CaseNode& node = take(key.name, true);
  KeyInfo& info = note(node, key, KeyType::text);
  info.pattern = rule.pattern;
  info.default_words = rule.default_words;
  if (!node.written) return std::nullopt;
  std::string value = read_text(node, {});
  expect_pattern(node, value, rule);
  return value;
}

std::string Table::choice(const Key& key, const std::vector<std::string>& choices,
                          const std::optional<std::string>& fallback, const std::string& default_words) const {
  CaseNode& node = take(key.name, fallback.has_value());
  KeyInfo& info = note(node, key, KeyType::choice, fallback ? toml_text(*fallback) : "", !fallback);
  info.choices = choices;
  info.default_words = default_words;
  return read_choice(node, choices, fallback);
}

std::optional<std::filesystem::path> Table::optional_path(const Key& key) const {
  CaseNode& node = take(key.name, true);
  note(node, key, KeyType::path);
  if (!node.written) return std::nullopt;
  return read_path(node, state_->path.parent_path());
}

std::vector<std::filesystem::path> Table::optional_paths(const Key& key) const {
  CaseNode& node = take(key.name, true);
  const std::filesystem::path folder = state_->path.parent_path();
  KeyInfo& info = with_limits(note(node, key, KeyType::path, "", false, true), ListRule{.least = 1});
  info.or_one = true;
  if (!node.written) return {};
  if (node.kind != Kind::array) return {read_path(node, folder)};
  if (node.children.empty()) fail(node, "must name a file, is an empty list");
  return read_array<std::filesystem::path>(
      node, info, std::optional<std::vector<std::string>>{},
      [&](CaseNode& entry, const std::optional<std::string>&) { return read_path(entry, folder); });
}

std::vector<double> Table::quantities(const Key& key, Dimension dimension, const QuantityRule& rule,
                                      const std::optional<std::vector<std::string>>& fallback,
                                      const ListRule& list) const {
  CaseNode& node = take(key.name, fallback.has_value());
  KeyInfo& info = note(node, key, KeyType::quantity, list_as_toml(fallback, quantity_as_toml), !fallback, true);
  with_limits(with_limits(info, dimension, rule), list);
  return read_array<double>(node, info, fallback, [&](CaseNode& entry, const auto& entry_fallback) {
    return read_quantity(entry, dimension, rule, entry_fallback);
  });
}

std::vector<std::int64_t> Table::integers(const Key& key, const IntegerRule& rule,
                                          const std::optional<std::vector<std::int64_t>>& fallback,
                                          const ListRule& list) const {
  CaseNode& node = take(key.name, fallback.has_value());
  const auto as_toml = [](std::int64_t entry) { return fmt::format("{}", entry); };
  KeyInfo& info = note(node, key, KeyType::integer, list_as_toml(fallback, as_toml), !fallback, true);
  with_limits(with_limits(info, rule), list);
  return read_array<std::int64_t>(node, info, fallback, [&](CaseNode& entry, const auto& entry_fallback) {
    return read_integer(entry, rule, entry_fallback);
  });
}

std::vector<std::string> Table::texts(const Key& key, const std::optional<std::vector<std::string>>& fallback,
                                      const TextRule& rule, const ListRule& list) const {
  CaseNode& node = take(key.name, fallback.has_value());
  KeyInfo& info = note(node, key, KeyType::text, list_as_toml(fallback, toml_text), !fallback, true);
  with_limits(info, list);
  info.pattern = rule.pattern;
  info.default_words = rule.default_words;
  return read_array<std::string>(node, info, fallback, [&](CaseNode& entry, const auto& entry_fallback) {
    std::string value = read_text(entry, entry_fallback);
    expect_pattern(entry, value, rule);
    return value;
  });
}

std::optional<Place> Table::optional_place(const Key& key, const QuantityRule& rule) const {
  CaseNode& node = take(key.name, true);
  with_limits(note(node, key, KeyType::place), Dimension::length, rule);
  if (!node.written) return std::nullopt;
  return read_place(node, rule);
}

std::vector<Place> Table::places(const Key& key, const QuantityRule& rule, const ListRule& list) const {
  CaseNode& node = take(key.name, true);
  KeyInfo& info = with_limits(note(node, key, KeyType::place, "", false, true), list);
  with_limits(info, Dimension::length, rule);
  if (!node.written) return {};
  return read_array<Place>(node, info, std::optional<std::vector<std::string>>{},
                           [&](CaseNode& entry, const std::optional<std::string>&) { return read_place(entry, rule); });
}

std::vector<std::string> Table::chosen(const Key& key, const std::vector<std::string>& choices) const {
  CaseNode& node = take(key.name, true);
  KeyInfo& info = with_limits(note(node, key, KeyType::choice, "[]", false, true), ListRule{});
  info.choices = choices;
  return read_array<std::string>(node, info, std::optional(std::vector<std::string>{}),
                                 [&](CaseNode& entry, const std::optional<std::string>& entry_fallback) {
                                   return read_choice(entry, choices, entry_fallback);
                                 });
}

CaseFile CaseFile::load(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return CaseFile(parse_case(path, overrides));
}

CaseFile CaseFile::of_text(const std::string& text, const std::string& name) {
  return CaseFile(parse_case_text(text, name));
}

Table CaseFile::root() const { return {state_, state_->root}; }

}  // namespace voussoir::io
