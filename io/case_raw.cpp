// Tables whose keys the user names, and values that the program hands on as they were written.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/case_file.hpp"
#include "io/case_node.hpp"
#include "io/case_value.hpp"

namespace voussoir::io {
namespace {

using Kind = CaseNode::Kind;

/// A value as TOML. It counts as read, and so do its entries.
std::string written_as_toml(CaseNode& node) {  // NOLINT(misc-no-recursion): as deep as the file's brackets
  node.read = true;
  switch (node.kind) {
    case Kind::text:
      return toml_text(std::get<std::string>(node.value));
    case Kind::integer:
      return fmt::format("{}", std::get<std::int64_t>(node.value));
    case Kind::number:
      return fmt::format("{}", std::get<double>(node.value));
    case Kind::boolean:
      return std::get<bool>(node.value) ? "true" : "false";
    case Kind::array: {
      std::vector<std::string> entries;
      for (const auto& entry : node.children) entries.push_back(written_as_toml(*entry));
      return fmt::format("[{}]", fmt::join(entries, ", "));
    }
    default:
      throw InputError(node.place, node.key,
                       fmt::format("must be a number, a text, true or false, is {}", kind_name(node.kind)));
  }
}

}  // namespace

std::string Table::place(std::string_view key) const {
  const CaseNode* node = node_->find(key);
  return node != nullptr ? node->place : node_->place;
}

std::vector<std::string> Table::names() const {
  std::vector<std::string> names;
  for (const auto& child : node_->children) {
    if (child->written) names.push_back(child->name);
  }
  return names;
}

CaseNode& Table::take_named(const Key& key, const std::string& name) const {
  CaseNode& node = take(name, false);
  node.placeholder = key.name;
  return node;
}

std::vector<std::string> Table::text_or_texts(const Key& key, const std::string& name) const {
  CaseNode& node = take_named(key, name);
  KeyInfo& info = node.info.emplace(KeyInfo{.key = node.key,
                                            .type = KeyType::text,
                                            .list = true,
                                            .or_one = true,
                                            .help = std::string(key.help),
                                            .named_by_user = true});
  info.most_entries = most_list_entries;
  if (node.kind != Kind::array) return {read_text(node, {})};
  std::vector<std::string> texts;
  for (const auto& entry : node.children) {
    entry->read = true;
    texts.push_back(read_text(*entry, {}));
  }
  return texts;
}

std::vector<std::string> Table::values_as_toml(const Key& key, const std::string& name) const {
  CaseNode& node = take_named(key, name);
  node.info.emplace(KeyInfo{.key = node.key,
                            .type = KeyType::value,
                            .list = true,
                            .or_one = true,
                            .least_entries = 1,
                            .help = std::string(key.help),
                            .named_by_user = true});
  if (node.kind != Kind::array) return {written_as_toml(node)};
  std::vector<std::string> values;
  for (const auto& entry : node.children) values.push_back(written_as_toml(*entry));
  return values;
}

std::vector<std::vector<std::string>> Table::lists_of_texts(const Key& key) const {
  std::vector<std::vector<std::string>> lists;
  CaseNode& node = take(key.name, true);
  node.info.emplace(KeyInfo{.key = node.key,
                            .type = KeyType::list_of_text,
                            .list = true,
                            .least_entries = 1,
                            .most_entries = most_list_entries,
                            .help = std::string(key.help)});
  if (!node.written) return lists;
  bool is_right = !node.children.empty();
  for (const auto& entry : node.children) {
    entry->read = true;
    std::vector<std::string>& list = lists.emplace_back();
    for (const auto& text : entry->children) {
      text->read = true;
      if (text->kind == Kind::text) list.push_back(std::get<std::string>(text->value));
    }
    is_right = is_right && !list.empty() && list.size() == entry->children.size();
  }
  if (!is_right) throw error(key.name, R"(must be an array of arrays of texts, such as [["a", "b"]])");
  node.resolved = written_as_toml(node);
  node.meaning = node.resolved;
  return lists;
}

}  // namespace voussoir::io
