#include "io/case_value.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "io/text_file.hpp"

namespace voussoir::io {

using Kind = CaseNode::Kind;

void fail(const CaseNode& node, const std::string& sentence) { throw InputError(node.place, node.key, sentence); }

void expect(const CaseNode& node, Kind kind) {
  if (node.kind != kind) {
    fail(node, fmt::format("must be {}, is {}", kind_name(kind), kind_name(node.kind)));
  }
}

namespace {

constexpr std::size_t most_text_bytes = 1000;  ///< of a text, which is a name or a path

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

}  // namespace

std::string quantity_as_toml(const std::string& written) {
  const bool is_number = written.find_first_not_of("0123456789+-.eE") == std::string::npos;
  return is_number ? written : toml_text(written);
}

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

std::string read_choice(CaseNode& node, const std::vector<std::string>& choices,
                        const std::optional<std::string>& fallback) {
  std::string value = read_text(node, fallback);
  if (std::find(choices.begin(), choices.end(), value) == choices.end()) {
    fail(node, fmt::format("must be one of {}, is {}", fmt::join(choices, ", "),
                           value.empty() ? "empty" : in_one_line(value)));
  }
  return value;
}

Place read_place(CaseNode& node, const QuantityRule& rule) {
  if (node.kind == Kind::text) {
    std::string name = read_text(node, {});
    if (name.empty()) fail(node, "must be the name of a point or two lengths, is empty");
    return {.name = std::move(name)};
  }
  if (node.kind != Kind::array || node.children.size() != 2) {
    fail(node, R"(must be the name of a point or two lengths, such as ["1 m", "2 m"])");
  }
  Place place;
  for (std::size_t k = 0; k < 2; ++k) {
    node.children[k]->read = true;
    place.at.at(k) = read_quantity(*node.children[k], Dimension::length, rule, {});
  }
  node.resolved = fmt::format("[{}, {}]", node.children[0]->resolved, node.children[1]->resolved);
  node.meaning = fmt::format("[{}, {}]", node.children[0]->meaning, node.children[1]->meaning);
  return place;
}

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

}  // namespace voussoir::io
