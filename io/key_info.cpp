#include "io/key_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/case_file.hpp"
#include "io/case_node.hpp"

namespace voussoir::io {

namespace {

/// "soil.class[3].size_to" -> "soil.class[].size_to".
std::string without_index(const std::string& key) {
  std::string out;
  bool inside = false;
  for (const char c : key) {
    inside = inside && c != ']';
    if (!inside) {
      out += c;
    }
    inside = inside || c == '[';
  }
  return out;
}

void collect(const CaseNode& node, std::vector<KeyInfo>& keys) {
  for (const auto& child : node.children) {
    if (child->info) {
      keys.push_back(*child->info);
      keys.back().key = without_index(child->key);
    } else {
      collect(*child, keys);
    }
  }
}

void collect_places(const CaseNode& node, std::map<std::string, std::string>& places) {
  for (const auto& child : node.children) {
    places[child->key] = child->place;
    collect_places(*child, places);
  }
}

/// A default without the quotes of TOML, which the quotes of a table would double.
std::string unquoted(const std::string& text) {
  return text.size() >= 2 && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2) : text;
}

/// A field of comma-separated values.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + '"';
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
  }
  return "value";
}

std::vector<KeyInfo> CaseFile::keys() const {
  std::vector<KeyInfo> keys;
  collect(state_->root, keys);
  return keys;
}

std::map<std::string, std::string> CaseFile::places() const {
  std::map<std::string, std::string> places;
  collect_places(state_->root, places);
  return places;
}

std::string key_table(const std::vector<KeyInfo>& keys) {
  std::string out = "key,type,dimension,default,at_least,at_most,choices\n";
  for (const KeyInfo& info : keys) {
    const bool measured = info.type == KeyType::quantity && info.dimension != Dimension::none;
    const std::string least = info.at_least.empty() && info.above_zero ? "> 0" : info.at_least;
    out += fmt::format("{},{}{},{},{},{},{},{}\n", info.key, info.list ? "list of " : "", name_of(info.type),
                       measured ? dimension_name(info.dimension) : "",
                       field(info.required ? "(required)" : unquoted(info.fallback)), field(least), field(info.at_most),
                       fmt::join(info.choices, "|"));
  }
  return out;
}

}  // namespace voussoir::io
