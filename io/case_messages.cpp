// Messages about values that have been read one by one and do not fit together.
#include <fmt/format.h>

#include "io/case_file.hpp"
#include "io/case_node.hpp"
#include "io/key_info.hpp"

namespace voussoir::io {
namespace {

/// "; size_maximum is not in the file, its default is 4.75 mm": without it the user searches the file for the key in
/// vain. Empty for keys that the user wrote, for tables, and for lists and texts that are empty by default.
std::string note_of_default(const CaseNode* node) {
  if (node == nullptr || node->written || node->resolved.empty()) return "";
  const std::string value = without_quotes(node->resolved);
  if (value.empty() || value == "[]") return "";
  return fmt::format("; {} is not in the file, its default is {}", node->name, value);
}

}  // namespace

std::string Table::shown(std::string_view key) const {
  const CaseNode* node = node_->find(key);
  return node == nullptr ? "" : without_quotes(node->resolved);
}

std::string Table::entry_shown(std::string_view key, std::size_t index) const {
  const CaseNode* node = node_->find(key);
  const bool is_there = node != nullptr && index < node->children.size();
  return fmt::format("entry {} ({})", index + 1, is_there ? without_quotes(node->children[index]->resolved) : "");
}

void Table::expect_order(std::string_view key, std::span<const double> values, Order order) const {
  const bool ascending = order == Order::ascending;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (ascending ? values[k] > values[k - 1] : values[k] >= values[k - 1]) continue;
    throw entry_error(key, k,
                      fmt::format("must {}, but {} is {} {}", ascending ? "ascend" : "not fall", entry_shown(key, k),
                                  ascending ? "not larger than" : "smaller than", entry_shown(key, k - 1)));
  }
}

InputError Table::error(std::string_view key, const std::string& sentence) const {
  return {place(key), full_key(key), sentence + note_of_default(node_->find(key))};
}

InputError Table::entry_error(std::string_view key, std::size_t index, const std::string& sentence) const {
  const CaseNode* node = node_->find(key);
  const bool is_there = node != nullptr && index < node->children.size();
  return {is_there ? node->children[index]->place : place(key), full_key(key), sentence};
}

}  // namespace voussoir::io
