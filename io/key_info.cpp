#include "io/key_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/case_file.hpp"
#include "io/case_node.hpp"

namespace voussoir::io {

namespace {

/// Adds the keys, or the tables, below `node`, whose name is `prefix`.
void collect(const CaseNode& node, const std::string& prefix, bool tables, std::vector<KeyInfo>& keys) {
  for (const auto& child : node.children) {
    const bool is_entry = child->name.front() == '[';
    const std::string& name = child->placeholder.empty() ? child->name : child->placeholder;
    std::string full = prefix;
    if (!is_entry && !prefix.empty()) full += '.';
    full += is_entry ? "[]" : name;
    const bool is_table = !child->info || child->info->type == KeyType::table;
    if (child->info && is_table == tables) {
      keys.push_back(*child->info);
      keys.back().key = full;
    }
    if (is_table) collect(*child, full, tables, keys);
  }
}

void collect_places(const CaseNode& node, std::map<std::string, std::string>& places) {
  for (const auto& child : node.children) {
    places[child->key] = child->place;
    collect_places(*child, places);
  }
}

}  // namespace

std::string_view name_of(KeyType type) {
  switch (type) {
    case KeyType::quantity:
      return "quantity";
    case KeyType::integer:
      return "integer";
    case KeyType::boolean:
      return "boolean";
    case KeyType::text:
      return "text";
    case KeyType::choice:
      return "choice";
    case KeyType::path:
      return "path";
    case KeyType::place:
      return "place";
    case KeyType::value:
      return "value";
    case KeyType::list_of_text:
      return "list of text";
    case KeyType::table:
      return "table";
  }
  return "value";
}

std::vector<KeyInfo> CaseFile::keys() const {
  std::vector<KeyInfo> keys{{.key = std::string(extends_key.name),
                             .type = KeyType::path,
                             .list = true,
                             .or_one = true,
                             .help = std::string(extends_key.help)}};
  collect(state_->root, "", false, keys);
  return keys;
}

std::vector<KeyInfo> CaseFile::tables() const {
  std::vector<KeyInfo> tables;
  collect(state_->root, "", true, tables);
  return tables;
}

std::map<std::string, std::string> CaseFile::places() const {
  std::map<std::string, std::string> places;
  collect_places(state_->root, places);
  return places;
}

std::string without_quotes(const std::string& text) {
  return text.size() >= 2 && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2) : text;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + '"';
}

std::string key_table_line(const KeyInfo& info) {
  const bool measured = info.type == KeyType::quantity && info.dimension != Dimension::none;
  const std::string least = info.at_least.empty() && info.above_zero ? "> 0" : info.at_least;
  const std::string fallback = info.default_words.empty() ? without_quotes(info.fallback) : info.default_words;
  return fmt::format("{},{}{},{},{},{},{},{},{}", info.key, info.list ? "list of " : "", name_of(info.type),
                     measured ? dimension_name(info.dimension) : "", csv_field(info.required ? "(required)" : fallback),
                     csv_field(least), csv_field(info.at_most), fmt::join(info.choices, "|"), csv_field(info.help));
}

}  // namespace voussoir::io
