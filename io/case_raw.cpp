// Tables whose keys the user names, and values that the program hands on as they were written.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/case_file.hpp"
#include "io/case_node.hpp"

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

bool Table::is_table(std::string_view key) const {
  const CaseNode* node = find(key);
  return node != nullptr && node->kind == Kind::table;
}

std::vector<Table> Table::table_or_tables(std::string_view key) const {
  if (is_table(key)) return {table(key)};
  return tables(key);
}

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

std::vector<std::string> Table::text_or_texts(std::string_view key) const {
  const CaseNode* node = find(key);
  if (node != nullptr && node->kind == Kind::array) return texts(key);
  return {text(key)};
}

std::vector<std::string> Table::values_as_toml(std::string_view key) const {
  CaseNode& node = take(key, false);
  if (node.kind != Kind::array) return {written_as_toml(node)};
  std::vector<std::string> values;
  for (const auto& entry : node.children) values.push_back(written_as_toml(*entry));
  return values;
}

std::vector<std::vector<std::string>> Table::lists_of_texts(std::string_view key) const {
  std::vector<std::vector<std::string>> lists;
  if (!has(key)) return lists;
  CaseNode& node = take(key, false);
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
  if (!is_right) throw error(key, R"(must be an array of arrays of texts, such as [["a", "b"]])");
  return lists;
}

}  // namespace voussoir::io
