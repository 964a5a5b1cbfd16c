#include "io/case_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "io/case_node.hpp"
#include "io/text_file.hpp"

namespace voussoir::io {

namespace {

using Kind = CaseNode::Kind;

constexpr std::size_t most_text_bytes = 1000;  ///< of a text, which is a name or a path
constexpr std::size_t most_entries = 100'000;  ///< of an array; such a list of points or seeds is still read in a
                                               ///< second

[[noreturn]] void fail(const CaseNode& node, const std::string& sentence) {
  throw InputError(node.place, node.key, sentence);
}

void expect(const CaseNode& node, Kind kind) {
  if (node.kind != kind) {
    fail(node, fmt::format("must be {}, is {}", kind_name(kind), kind_name(node.kind)));
  }
}

/// The quantity as the user wrote it, to be parsed like a quantity in quotes.
std::string written_quantity(const CaseNode& node, Dimension dimension) {
  switch (node.kind) {
    case Kind::text:
      return std::get<std::string>(node.value);
    case Kind::integer:
      return fmt::format("{}", std::get<std::int64_t>(node.value));
    case Kind::number:
      return fmt::format("{}", std::get<double>(node.value));
    default:
      break;
  }
  const bool plain = dimension == Dimension::none;
  fail(node,
       fmt::format("must be {}, is {}",
                   plain ? "a number" : "a quantity in quotes, such as \"1 " + std::string(si_unit(dimension)) + "\"",
                   kind_name(node.kind)));
}

/// Reads one quantity in SI and compares it with its limits. A written -0 becomes 0.
double checked_quantity(const CaseNode& node, const std::string& written, Dimension dimension,
                        const QuantityRule& rule) {
  double value = 0;
  try {
    value = parse_quantity(written, dimension);
  } catch (const UnitError& error) {
    fail(node, error.what());
  }
  if (rule.positive && !(value > 0)) {
    fail(node, fmt::format("must be positive, is {}", in_one_line(written)));
  }
  if (rule.at_least && !(value >= parse_quantity(*rule.at_least, dimension))) {
    fail(node, fmt::format("must be at least {}, is {}", *rule.at_least, in_one_line(written)));
  }
  if (rule.at_most && !(value <= parse_quantity(*rule.at_most, dimension))) {
    fail(node, fmt::format("must be at most {}, is {}", *rule.at_most, in_one_line(written)));
  }
  return value + 0.0;
}

/// Twelve digits, because equal quantities in two units may differ in the last bit of a double, and no input is known
/// more exactly.
std::string significant(double in_si) {
  return fmt::format("{:.12g}", in_si == 0 ? 0.0 : in_si);  // so that -0 is written as "0"
}

/// Notes what kind of value a key has. `as_toml` is its default; `required` says that it has none and must be given.
KeyInfo& note(CaseNode& node, KeyType type, std::string as_toml, bool required, bool list = false) {
  return node.info.emplace(
      KeyInfo{.key = node.key, .type = type, .list = list, .fallback = std::move(as_toml), .required = required});
}

KeyInfo& with_limits(KeyInfo& info, Dimension dimension, const QuantityRule& rule) {
  info.dimension = dimension;
  info.at_least = rule.at_least.value_or("");
  info.at_most = rule.at_most.value_or("");
  info.above_zero = rule.positive;
  return info;
}

KeyInfo& with_limits(KeyInfo& info, const IntegerRule& rule) {
  if (rule.at_least) {
    info.at_least = fmt::format("{}", *rule.at_least);
  }
  if (rule.at_most) {
    info.at_most = fmt::format("{}", *rule.at_most);
  }
  return info;
}

/// A default as TOML: without quotes where it is a plain number.
std::string quantity_as_toml(const std::string& written) {
  const bool is_number = written.find_first_not_of("0123456789+-.eE") == std::string::npos;
  return is_number ? written : toml_text(written);
}

/// The fallback of a key that the user did not write; Table::take has refused such a key where there is none.
template <class T>
const T& given(const std::optional<T>& fallback) {
  // NOLINTNEXTLINE(bugprone-unchecked-optional-access): value() itself checks, and throws.
  return fallback.value();
}

/// Reads one quantity and notes it as TOML; `fallback` stands in for a node that the user did not write.
double read_quantity(CaseNode& node, Dimension dimension, const QuantityRule& rule,
                     const std::optional<std::string>& fallback) {
  const std::string written = node.written ? written_quantity(node, dimension) : given(fallback);
  const double value = checked_quantity(node, written, dimension, rule);
  node.resolved = quantity_as_toml(written);
  node.meaning = significant(value);
  return value;
}

std::int64_t read_integer(CaseNode& node, const IntegerRule& rule, const std::optional<std::int64_t>& fallback) {
  if (node.written) {
    expect(node, Kind::integer);
  }
  const std::int64_t value = node.written ? std::get<std::int64_t>(node.value) : given(fallback);
  if (rule.at_least && value < *rule.at_least) {
    fail(node, fmt::format("must be at least {}, is {}", *rule.at_least, value));
  }
  if (rule.at_most && value > *rule.at_most) {
    fail(node, fmt::format("must be at most {}, is {}", *rule.at_most, value));
  }
  node.resolved = fmt::format("{}", value);
  node.meaning = node.resolved;
  return value;
}

/// Reads a text. Control characters are refused: a text becomes a name of a file, or a part of a line of the log.
std::string read_text(CaseNode& node, const std::optional<std::string>& fallback) {
  if (node.written) {
    expect(node, Kind::text);
  }
  const std::string value = node.written ? std::get<std::string>(node.value) : given(fallback);
  if (std::any_of(value.begin(), value.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; })) {
    fail(node, fmt::format("must not hold control characters such as line breaks, is \"{}\"", in_one_line(value)));
  }
  if (value.size() > most_text_bytes) {
    fail(node, fmt::format("must have at most {} bytes, has {}", most_text_bytes, value.size()));
  }
  node.resolved = toml_text(value);
  node.meaning = node.resolved;
  return value;
}

/// Reads an array entry by entry: read_one(entry, default of this entry) -> value. `info` is the node's own.
template <class T, class Default, class ReadOne>
std::vector<T> read_array(CaseNode& node, KeyInfo& info, const std::optional<std::vector<Default>>& fallback,
                          ReadOne read_one) {
  if (node.written) {
    expect(node, Kind::array);
    if (node.children.size() > most_entries) {
      fail(node, fmt::format("must have at most {} entries, has {}", most_entries, node.children.size()));
    }
  } else if (node.children.empty()) {
    for (std::size_t i = 0; i < given(fallback).size(); ++i) {
      node.add(fmt::format("[{}]", i), node.place);
    }
  }
  std::vector<T> values;
  std::vector<std::string> texts;
  std::vector<std::string> meanings;
  for (const auto& entry : node.children) {
    entry->read = true;
    values.push_back(read_one(*entry, node.written ? std::optional<Default>{} : given(fallback).at(values.size())));
    texts.push_back(entry->resolved);
    meanings.push_back(entry->meaning);
  }
  node.resolved = fmt::format("[{}]", fmt::join(texts, ", "));
  info.fallback = node.written ? "" : node.resolved;
  info.most_entries = most_entries;
  node.meaning = fmt::format("[{}]", fmt::join(meanings, ", "));
  return values;
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

double Table::quantity(std::string_view key, Dimension dimension, const QuantityRule& rule) const {
  CaseNode& node = take(key, rule.fallback.has_value());
  with_limits(note(node, KeyType::quantity, rule.fallback ? quantity_as_toml(*rule.fallback) : "", !rule.fallback),
              dimension, rule);
  return read_quantity(node, dimension, rule, rule.fallback);
}

std::int64_t Table::integer(std::string_view key, const IntegerRule& rule) const {
  CaseNode& node = take(key, rule.fallback.has_value());
  with_limits(note(node, KeyType::integer, rule.fallback ? fmt::format("{}", *rule.fallback) : "", !rule.fallback),
              rule);
  return read_integer(node, rule, rule.fallback);
}

bool Table::boolean(std::string_view key, std::optional<bool> fallback) const {
  CaseNode& node = take(key, fallback.has_value());
  note(node, KeyType::boolean, fallback ? (*fallback ? "true" : "false") : "", !fallback);
  if (node.written) {
    expect(node, Kind::boolean);
  }
  const bool value = node.written ? std::get<bool>(node.value) : given(fallback);
  node.resolved = value ? "true" : "false";
  node.meaning = node.resolved;
  return value;
}

std::string Table::text(std::string_view key, const std::optional<std::string>& fallback) const {
  CaseNode& node = take(key, fallback.has_value());
  note(node, KeyType::text, fallback ? toml_text(*fallback) : "", !fallback);
  return read_text(node, fallback);
}

std::string Table::choice(std::string_view key, const std::vector<std::string>& choices,
                          const std::optional<std::string>& fallback) const {
  CaseNode& node = take(key, fallback.has_value());
  note(node, KeyType::choice, fallback ? toml_text(*fallback) : "", !fallback).choices = choices;
  std::string value = read_text(node, fallback);
  if (std::find(choices.begin(), choices.end(), value) == choices.end()) {
    fail(node, fmt::format("must be one of {}, is {}", fmt::join(choices, ", "),
                           value.empty() ? "empty" : in_one_line(value)));
  }
  return value;
}

namespace {

/// The path that a node names. A path that is written with --set is relative to `folder_of_case`.
std::filesystem::path read_path(CaseNode& node, const std::filesystem::path& folder_of_case) {
  const std::string written = read_text(node, {});
  if (written.empty()) {
    fail(node, "must be the name of a file, is empty");
  }
  const auto path = (node.place == "--set" ? folder_of_case : node.folder) / written;
  const std::string fault = file_fault(path);
  if (!fault.empty()) {
    fail(node, fmt::format("{} {}", in_one_line(path.string()), fault));
  }
  return path;
}

}  // namespace

std::filesystem::path Table::path(std::string_view key) const {
  CaseNode& node = take(key, false);
  note(node, KeyType::path, "", true);
  return read_path(node, state_->path.parent_path());
}

std::vector<std::filesystem::path> Table::optional_paths(std::string_view key) const {
  CaseNode& node = take(key, true);
  const std::filesystem::path folder = state_->path.parent_path();
  KeyInfo& info = note(node, KeyType::path, "", false, node.kind == Kind::array);
  if (!node.written) return {};
  if (node.kind != Kind::array) return {read_path(node, folder)};
  if (node.children.empty()) fail(node, "must name a file, is an empty list");
  return read_array<std::filesystem::path>(
      node, info, std::optional<std::vector<std::string>>{},
      [&](CaseNode& entry, const std::optional<std::string>&) { return read_path(entry, folder); });
}

std::vector<double> Table::quantities(std::string_view key, Dimension dimension, const QuantityRule& rule,
                                      const std::optional<std::vector<std::string>>& fallback) const {
  CaseNode& node = take(key, fallback.has_value());
  KeyInfo& info = with_limits(note(node, KeyType::quantity, "", !fallback, true), dimension, rule);
  return read_array<double>(node, info, fallback, [&](CaseNode& entry, const auto& entry_fallback) {
    return read_quantity(entry, dimension, rule, entry_fallback);
  });
}

std::vector<std::int64_t> Table::integers(std::string_view key, const IntegerRule& rule,
                                          const std::optional<std::vector<std::int64_t>>& fallback) const {
  CaseNode& node = take(key, fallback.has_value());
  KeyInfo& info = with_limits(note(node, KeyType::integer, "", !fallback, true), rule);
  return read_array<std::int64_t>(node, info, fallback, [&](CaseNode& entry, const auto& entry_fallback) {
    return read_integer(entry, rule, entry_fallback);
  });
}

std::vector<std::string> Table::texts(std::string_view key,
                                      const std::optional<std::vector<std::string>>& fallback) const {
  CaseNode& node = take(key, fallback.has_value());
  KeyInfo& info = note(node, KeyType::text, "", !fallback, true);
  return read_array<std::string>(node, info, fallback, read_text);
}

Table Table::table(std::string_view key) const {
  CaseNode& node = take(key, true);
  if (node.written) {
    expect(node, Kind::table);
  }
  node.kind = Kind::table;
  return {state_, node};
}

std::vector<Table> Table::tables(std::string_view key) const {
  std::vector<Table> all;
  CaseNode* node = find(key);
  if (node == nullptr) {
    return all;
  }
  node->read = true;
  expect(*node, Kind::array);
  for (const auto& entry : node->children) {
    expect(*entry, Kind::table);
    entry->read = true;
    all.push_back(Table(state_, *entry));
  }
  return all;
}

InputError Table::error(std::string_view key, const std::string& sentence) const {
  return {place(key), full_key(key), sentence};
}

CaseFile CaseFile::load(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return CaseFile(parse_case(path, overrides));
}

CaseFile CaseFile::of_text(const std::string& text, const std::string& name) {
  return CaseFile(parse_case_text(text, name));
}

Table CaseFile::root() const { return {state_, state_->root}; }

}  // namespace voussoir::io
