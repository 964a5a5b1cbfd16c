// Tables of a case file.
#include "io/case_file.hpp"
#include "io/case_node.hpp"
#include "io/case_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace voussoir::io {
namespace {

using Kind = CaseNode::Kind;

KeyInfo& note_table(CaseNode& node, const Key& key, bool list) {
  return node.info.emplace(
      KeyInfo{.key = node.key, .type = KeyType::table, .list = list, .help = std::string(key.help)});
}

bool names(const std::vector<std::string_view>& keys, std::string_view key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// What is not taken over into this table: its own keys, and those that exclude one of them.
bool is_left_out(const CaseNode& table, const TakeOverRule& rule, std::string_view key) {
  const auto is_written = [&](std::string_view name) {
    return std::any_of(table.children.begin(), table.children.end(),
                       [&](const auto& child) { return child->written && child->name == name; });
  };
  if (names(rule.without, key)) return true;
  return std::any_of(rule.alternatives.begin(), rule.alternatives.end(), [&](const auto& group) {
    return names(group, key) && std::any_of(group.begin(), group.end(), is_written);
  });
}

/// A value with all that is in it.
void copy_value(const CaseNode& from, const std::string& origin, CaseNode& to) {  // NOLINT(misc-no-recursion)
  to.place = from.place;
  to.folder = from.folder;
  to.kind = from.kind;
  to.value = from.value;
  to.written = true;
  to.origin = origin.empty() ? from.place : origin;
  for (const auto& child : from.children) {
    if (child->written) copy_value(*child, origin, to.add(child->name, child->place));
  }
}

/// Puts the written keys of `from` below those of `to`.
void put_under(const CaseNode& from, const TakeOverRule& rule, const std::string& origin,  // NOLINT(misc-no-recursion)
               CaseNode& to) {
  std::vector<const CaseNode*> taken;  // chosen before any is there, since keys of one group may come together
  for (const auto& child : from.children) {
    if (child->written && !is_left_out(to, rule, child->name)) taken.push_back(child.get());
  }
  for (const CaseNode* child : taken) {
    CaseNode* known = to.find(child->name);
    const bool joins = known != nullptr && known->kind == Kind::table && child->kind == Kind::table;
    if (joins) {
      put_under(*child, {}, origin, *known);
    } else if (known == nullptr || !known->written) {
      copy_value(*child, origin, known == nullptr ? to.add(child->name, child->place) : *known);
    }
  }
}

}  // namespace

std::optional<CaseFile> Table::extended(const Key& key) const {
  CaseNode& node = take(key.name, true);
  node.info.emplace(
      KeyInfo{.key = node.key, .type = KeyType::path, .list = true, .or_one = true, .help = std::string(key.help)});
  if (!node.written) return std::nullopt;
  for (const auto& entry : node.children) entry->read = true;
  return CaseFile(parse_extended(node, state_->path.parent_path()));
}

void Table::take_over(const Table& other, const TakeOverRule& rule, const std::string& origin) const {
  put_under(*other.node_, rule, origin, *node_);
}

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
