#include "io/case_compare.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "io/units.hpp"

namespace voussoir::io {

namespace {

using KeyTexts = std::vector<std::pair<std::string, std::string>>;

std::string text_of(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
  std::string list;
  if (const auto* array = node.as_array()) {
    for (const auto& entry : *array) list += (list.empty() ? "" : ", ") + text_of(entry);
  }
  return "[" + list + "]";
}

/// toml++ keeps the keys of a table sorted by name.
void flatten(const toml::table& table, const std::string& prefix, KeyTexts& to) {
  for (const auto& [name, node] : table) {
    const std::string key = prefix + std::string(name.str());
    const auto* array = node.as_array();
    if (const auto* inner = node.as_table()) {
      flatten(*inner, key + ".", to);
    } else if (array != nullptr && !array->empty() && array->get(0)->is_table()) {
      for (std::size_t k = 0; k < array->size(); ++k) {
        if (const auto* entry = array->get(k)->as_table()) flatten(*entry, fmt::format("{}[{}].", key, k), to);
      }
    } else {
      to.emplace_back(key, text_of(node));
    }
  }
}

KeyTexts parsed(const std::string& resolved) {
  KeyTexts keys;
  try {
    flatten(toml::parse(resolved), "", keys);
  } catch (const toml::parse_error& error) {
    throw std::runtime_error("a resolved case is no TOML: " + std::string(error.description()));
  }
  return keys;
}

const std::string* find(const KeyTexts& keys, const std::string& key) {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const auto& entry) { return entry.first == key; });
  return found == keys.end() ? nullptr : &found->second;
}

std::optional<double> value_of(std::string_view text, Dimension dimension) {
  try {
    return parse_quantity(text, dimension);
  } catch (const UnitError&) {
    return std::nullopt;
  }
}

/// The entries of "[a, b]"; the text itself where it is no list.
std::vector<std::string_view> entries(std::string_view text) {
  std::vector<std::string_view> all;
  if (!text.starts_with('[') || !text.ends_with(']')) return {text};
  text = text.substr(1, text.size() - 2);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(", "), text.size());
    all.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 2, text.size()));
  }
  return all;
}

bool same_entry(std::string_view a, std::string_view b) {
  if (a == b) return true;
  for (const Dimension dimension : {Dimension::none, Dimension::length, Dimension::pressure, Dimension::unit_weight,
                                    Dimension::density, Dimension::angle}) {
    const auto x = value_of(a, dimension), y = value_of(b, dimension);
    if (x && y) return std::abs(*x - *y) <= 1e-12 * std::max(std::abs(*x), std::abs(*y));
  }
  return false;
}

bool is_within(const std::string& key, const std::string& table) {
  return key.starts_with(table) && (key.size() == table.size() || key[table.size()] == '.' || key[table.size()] == '[');
}

}  // namespace

bool same_value(std::string_view a, std::string_view b) {
  const auto ours = entries(a), theirs = entries(b);
  return std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end(), same_entry);
}

std::vector<KeyDifference> differences(const std::string& ours, const std::string& theirs,
                                       std::span<const std::string> without) {
  const KeyTexts mine = parsed(ours), others = parsed(theirs);
  const auto left_out = [&](const std::string& key) {
    return std::any_of(without.begin(), without.end(), [&](const std::string& table) { return is_within(key, table); });
  };
  std::vector<KeyDifference> found;
  for (const auto& [key, text] : mine) {
    const std::string* other = find(others, key);
    if (left_out(key) || (other != nullptr && same_value(text, *other))) continue;
    found.push_back({key, text, other != nullptr ? *other : "nothing"});
  }
  for (const auto& [key, text] : others) {
    if (!left_out(key) && find(mine, key) == nullptr) found.push_back({key, "nothing", text});
  }
  return found;
}

std::string describe(std::span<const KeyDifference> differences, std::string_view maker) {
  constexpr std::size_t in_full = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(in_full, differences.size()); ++k) {
    const KeyDifference& d = differences[k];
    text += fmt::format("{}{}: this case has {}, {} was made with {}", k > 0 ? "; " : "", d.key, d.ours, maker,
                        d.theirs);
  }
  for (std::size_t k = in_full; k < differences.size(); ++k) {
    text += (k == in_full ? "; other values also of " : ", ") + differences[k].key;
  }
  return text;
}

}  // namespace voussoir::io
