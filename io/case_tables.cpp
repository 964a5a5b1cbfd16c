// Tables of a case file.
#include "io/case_file.hpp"
#include "io/case_node.hpp"
#include "io/case_value.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace voussoir::io {
namespace {

using Kind = CaseNode::Kind;

KeyInfo& note_table(CaseNode& node, const Key& key, bool list) {
  return node.info.emplace(
      KeyInfo{.key = node.key, .type = KeyType::table, .list = list, .help = std::string(key.help)});
}

}  // namespace

Table Table::table(const Key& key) const {
  CaseNode& node = take(key.name, true);
  if (node.written) {
    expect(node, Kind::table);
  }
  node.kind = Kind::table;
  note_table(node, key, false);
  return {state_, node};
}

std::vector<Table> Table::tables(const Key& key) const {
  CaseNode* node = find(key.name);
  if (node == nullptr) {
    return {};
  }
  node->read = true;
  expect(*node, Kind::array);
  for (const auto& entry : node->children) {
    expect(*entry, Kind::table);
    entry->read = true;
  }
  note_table(*node, key, true);
  return known_tables(key.name);
}

std::vector<Table> Table::table_or_tables(const Key& key) const {
  if (is_table(key.name)) return {table(key)};
  std::vector<Table> all = tables(key);
  if (CaseNode* node = find(key.name)) note_table(*node, key, true).or_one = true;
  return all;
}

Table Table::named_table(const Key& key, const std::string& name) const {
  CaseNode& node = take_named(key, name);
  expect(node, Kind::table);
  note_table(node, key, false).named_by_user = true;
  return {state_, node};
}

bool Table::is_table(std::string_view key) const {
  const CaseNode* node = find(key);
  return node != nullptr && node->kind == Kind::table;
}

Table Table::known_table(std::string_view key) const {
  CaseNode* node = node_->find(key);
  if (node == nullptr || !node->read || node->kind != Kind::table)
    throw std::logic_error(full_key(key) + " is no table that has been read");
  return {state_, *node};
}

std::vector<Table> Table::known_tables(std::string_view key) const {
  std::vector<Table> all;
  const CaseNode* node = find(key);
  if (node == nullptr) return all;
  for (const auto& entry : node->children) all.push_back(Table(state_, *entry));
  return all;
}

}  // namespace voussoir::io
