#include "io/case_node.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "io/case_file.hpp"

namespace voussoir::io {

namespace {

struct Origin {
  std::string file;  ///< empty for an override

  [[nodiscard]] std::string place(const toml::node& node) const {
    return file.empty() ? "--set" : fmt::format("{}:{}", file, node.source().begin.line);
  }
};

/// toml++ keeps tables sorted by name; people expect their own order back.
std::vector<std::pair<std::string, const toml::node*>> in_file_order(const toml::table& table) {
  std::vector<std::pair<std::string, const toml::node*>> entries;
  for (const auto& [key, value] : table) {
    entries.emplace_back(key.str(), &value);
  }
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    const auto at = [](const auto& entry) { return entry.second->source().begin; };
    return std::pair(at(a).line, at(a).column) < std::pair(at(b).line, at(b).column);
  });
  return entries;
}

/// Copies a TOML value into a node.
void fill(CaseNode& node, const toml::node& from, const Origin& origin) {
  node.written = true;
  node.place = origin.place(from);
  node.children.clear();
  if (const auto* table = from.as_table()) {
    node.kind = CaseNode::Kind::table;
    for (const auto& [key, value] : in_file_order(*table)) {
      fill(node.add(key, {}), *value, origin);
    }
  } else if (const auto* array = from.as_array()) {
    node.kind = CaseNode::Kind::array;
    for (std::size_t i = 0; i < array->size(); ++i) {
      fill(node.add(fmt::format("[{}]", i), {}), (*array)[i], origin);
    }
  } else if (const auto* text = from.as_string()) {
    node.kind = CaseNode::Kind::text;
    node.value = text->get();
  } else if (const auto* integer = from.as_integer()) {
    node.kind = CaseNode::Kind::integer;
    node.value = integer->get();
  } else if (const auto* number = from.as_floating_point()) {
    node.kind = CaseNode::Kind::number;
    node.value = number->get();
  } else if (const auto* boolean = from.as_boolean()) {
    node.kind = CaseNode::Kind::boolean;
    node.value = boolean->get();
  } else {
    node.kind = CaseNode::Kind::other;
  }
}

toml::table parse_toml(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}", file, error.source().begin.line), "", std::string(error.description()));
  }
}

/// "stage[0].steps" -> "stage", "[0]", "steps"; empty when it is no key.
std::vector<std::string> split_key(std::string_view key) {
  std::vector<std::string> parts;
  std::string part;
  const auto end_part = [&] { return part.empty() ? false : (parts.push_back(std::exchange(part, {})), true); };
  for (const char c : key) {
    if (c == '.') {
      if (!end_part()) {
        return {};
      }
    } else if (c == '[') {
      if (!end_part()) {
        return {};
      }
      part.assign(1, '[');
    } else {
      part += c;
    }
  }
  return end_part() ? parts : std::vector<std::string>{};
}

/// Values are TOML, or else text without quotes.
void fill_override(CaseNode& node, std::string_view value) {
  std::optional<toml::table> parsed;
  try {
    parsed = toml::parse(fmt::format("value = {}", value));
  } catch (const toml::parse_error&) {
    parsed = toml::table{{"value", std::string(value)}};
  }
  // A line break would smuggle further keys into the parsed line.
  if (parsed->size() != 1) {
    throw InputError("--set", node.key, fmt::format("\"{}\" is more than one value", value));
  }
  fill(node, *parsed->get("value"), Origin{});
}

void apply_override(CaseNode& root, const std::string& override_text) {
  const auto equals = override_text.find('=');
  const auto parts = split_key(override_text.substr(0, equals));
  if (equals == std::string::npos || parts.empty()) {
    throw InputError("--set", "", fmt::format("\"{}\" is not of the form table.key=value", override_text));
  }
  CaseNode* node = &root;
  for (const auto& part : parts) {
    CaseNode* next = node->find(part);
    if (next == nullptr && (part.front() == '[' || node->kind == CaseNode::Kind::array)) {
      throw InputError("--set", node->key, fmt::format("has no entry {}", part));
    }
    if (next == nullptr) {
      next = &node->add(part, "--set");
      if (node->kind != CaseNode::Kind::table) {
        node->kind = CaseNode::Kind::table;
        node->written = true;
      }
    }
    node = next;
  }
  fill_override(*node, override_text.substr(equals + 1));
}

}  // namespace

CaseNode* CaseNode::find(std::string_view child_name) {
  for (const auto& child : children) {
    if (child->name == child_name) {
      return child.get();
    }
  }
  return nullptr;
}

CaseNode& CaseNode::add(std::string child_name, std::string child_place) {
  const bool joins_directly = key.empty() || child_name.front() == '[';
  auto child = std::make_unique<CaseNode>();
  child->key = fmt::format("{}{}{}", key, joins_directly ? "" : ".", child_name);
  child->name = std::move(child_name);
  child->place = std::move(child_place);
  return *children.emplace_back(std::move(child));
}

std::shared_ptr<CaseState> parse_case(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (std::filesystem::is_directory(path) || !file || !(text << file.rdbuf())) {
    throw InputError(path.string(), "", "cannot be read: no such file, empty, or no permission");
  }
  auto state = std::make_shared<CaseState>();
  state->path = path;
  const auto parsed = parse_toml(text.str(), path.string());
  fill(state->root, parsed, Origin{path.string()});
  state->root.place = fmt::format("{}:1", path.string());
  state->root.read = true;
  for (const auto& item : overrides) {
    apply_override(state->root, item);
  }
  return state;
}

std::string_view kind_name(CaseNode::Kind kind) {
  switch (kind) {
    case CaseNode::Kind::absent:
      return "missing";
    case CaseNode::Kind::boolean:
      return "true or false";
    case CaseNode::Kind::integer:
      return "an integer";
    case CaseNode::Kind::number:
      return "a number";
    case CaseNode::Kind::text:
      return "text";
    case CaseNode::Kind::array:
      return "an array";
    case CaseNode::Kind::table:
      return "a table";
    case CaseNode::Kind::other:
      return "a date or time";
  }
  return "a value";
}

std::string toml_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

}  // namespace voussoir::io
