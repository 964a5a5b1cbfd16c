#include "io/case_node.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "io/case_file.hpp"
#include "io/text_file.hpp"

namespace voussoir::io {

namespace {

struct Origin {
  std::string file;              ///< empty for an override
  std::filesystem::path folder;  ///< folder to which paths written there are relative

  [[nodiscard]] std::string place(const toml::node& node) const {
    return file.empty() ? "--set" : fmt::format("{}:{}", file, node.source().begin.line);
  }
};

/// toml++ keeps tables sorted by name; users expect the order of their file.
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

/// Copies a TOML value into a node, in place of the value that the node had. A table is joined with the table that
/// stood there before, of an extended file or, for `--set`, of the case: keys that stand there alone stay, because
/// whoever sets one key of a table does not mean to lose the others.
void fill(CaseNode& node, const toml::node& from, const Origin& origin) {
  const bool joins = node.kind == CaseNode::Kind::table && from.is_table();
  node.written = true;
  node.place = origin.place(from);
  node.folder = origin.folder;
  if (!joins) {
    node.children.clear();
  }
  if (const auto* table = from.as_table()) {
    node.kind = CaseNode::Kind::table;
    const bool is_new = node.children.empty();  // the keys of one table differ, so that none of them is searched for
    for (const auto& [key, value] : in_file_order(*table)) {
      CaseNode* known = is_new ? nullptr : node.find(key);
      fill(known != nullptr ? *known : node.add(key, {}), *value, origin);
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

/// Refuses keys of very many parts, such as "a.a.a.a", and very many open brackets: tables in tables in tables would
/// exhaust the stack.
void refuse_deep_keys(const std::string& text, const std::string& file) {
  constexpr int most_parts = 100;
  std::size_t line = 1;
  int parts = 0, open = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    line += c == '\n' ? 1U : 0U;
    open = std::max(0, open + (c == '[' || c == '{' ? 1 : 0) - (c == ']' || c == '}' ? 1 : 0));
    if (c == '.') {
      ++parts;
    } else if (std::isalnum(byte) == 0 && std::string_view("_-\"' \t").find(c) == std::string_view::npos &&
               byte < 0x80) {
      parts = 0;
    }
    if (parts > most_parts || open > most_parts) {
      const std::string what = parts > most_parts ? fmt::format("a key of more than {} parts", most_parts)
                                                  : fmt::format("more than {} open brackets", most_parts);
      throw InputError(fmt::format("{}:{}", file, line), "", "has " + what);
    }
  }
}

toml::table parse_toml(const std::string& text, const std::string& file) {
  refuse_deep_keys(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}", file, error.source().begin.line), "",
                     fmt::format("is no TOML: {}", in_one_line(error.description())));
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

/// Reads the value as TOML, or as text where it is none, so that quotes may be left out.
void fill_override(CaseNode& node, std::string_view value) {
  constexpr std::size_t most_bytes = 100'000;
  if (find_wrong_utf8(value) != std::string_view::npos || value.size() > most_bytes) {
    throw InputError("--set", node.key,
                     fmt::format("\"{}\" is no text in UTF-8 of at most {} bytes", in_one_line(value), most_bytes));
  }
  std::optional<toml::table> parsed;
  try {
    refuse_deep_keys(std::string(value), "--set");
    parsed = toml::parse(fmt::format("value = {}", value));
  } catch (const toml::parse_error& error) {
    // What begins like a table, an array or a whole number is meant as one.
    const bool is_meant = value.starts_with('{') || value.starts_with('[') ||
                          value.find_first_not_of("0123456789_") == std::string_view::npos;
    if (is_meant && !value.empty()) {
      throw InputError("--set", node.key,
                       fmt::format("\"{}\" is no TOML: {}", in_one_line(value), in_one_line(error.description())));
    }
    parsed = toml::table{{"value", std::string(value)}};
  }
  // A line break in the value would make further keys of the text behind it.
  if (parsed->size() != 1) {
    throw InputError("--set", node.key, fmt::format("\"{}\" is more than one value", in_one_line(value)));
  }
  fill(node, *parsed->get("value"), Origin{});
}

void apply_override(CaseNode& root, const std::string& override_text) {
  const auto equals = override_text.find('=');
  const auto parts = split_key(override_text.substr(0, equals));
  constexpr std::size_t most_parts = 100;
  if (equals == std::string::npos || parts.empty() || parts.size() > most_parts ||
      find_wrong_utf8(override_text.substr(0, equals)) != std::string::npos) {
    throw InputError("--set", "", fmt::format("\"{}\" is not of the form table.key=value", in_one_line(override_text)));
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

constexpr std::size_t most_case_bytes = 4'000'000;  ///< of a case file, whose largest part is a path of a probe

std::string read_whole(const std::filesystem::path& path) {
  try {
    return read_text_file(path, most_case_bytes);
  } catch (const TextFileError& error) {
    const std::string name = in_one_line(path.string());
    throw InputError(error.line > 0 ? fmt::format("{}:{}", name, error.line) : name, "", error.what());
  }
}

/// The names under the key `extends`: one text or an array of them.
std::vector<std::string> extended_names(const toml::node& written, const std::string& place) {
  std::vector<std::string> names;
  const auto take = [&](const toml::node& entry) {
    if (!entry.is_string()) {
      throw InputError(place, std::string(extends_key.name),
                       "must be the name of a case file, or an array of such names");
    }
    names.push_back(entry.as_string()->get());
  };
  if (const auto* list = written.as_array()) {
    for (const auto& entry : *list) {
      take(entry);
    }
  } else {
    take(written);
  }
  return names;
}

/// The key that names files, its place, and how many files lead to it.
struct Extension {
  std::string key, place;
  int depth;
};

void fill_from_file(CaseNode& root, const std::filesystem::path& path, int depth);

/// Reads the files that a key `extends` names, in their order.
void fill_from_extended(CaseNode& root, const std::filesystem::path& folder,  // NOLINT(misc-no-recursion)
                        const std::vector<std::string>& names, const Extension& at) {
  constexpr int most_files = 8;  // deeper chains are taken for circles
  for (const auto& name : names) {
    const std::string fault = name.empty() ? "is no name of a file" : file_fault(folder / name);
    if (!fault.empty()) {
      throw InputError(at.place, at.key, fmt::format("{} {}", in_one_line((folder / name).string()), fault));
    }
    if (at.depth == most_files) {
      throw InputError(at.place, at.key, "the files extend one another in a circle, or more than eight deep");
    }
    fill_from_file(root, folder / name, at.depth + 1);
  }
}

/// Reads the files that this file extends, in their order, then this file over them.
void fill_from_file(CaseNode& root, const std::filesystem::path& path, int depth) {  // NOLINT(misc-no-recursion)
  const auto folder = path.parent_path();
  auto parsed = parse_toml(read_whole(path), path.string());
  const Origin origin{path.string(), folder};
  if (const toml::node* written = parsed.get(extends_key.name)) {
    const std::string place = origin.place(*written);
    fill_from_extended(root, folder, extended_names(*written, place), {std::string(extends_key.name), place, depth});
    parsed.erase(extends_key.name);
  }
  fill(root, parsed, origin);
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
  auto state = std::make_shared<CaseState>();
  state->path = path;
  state->root.kind = CaseNode::Kind::table;
  fill_from_file(state->root, path, 0);
  state->root.place = fmt::format("{}:1", path.string());
  state->root.read = true;
  for (const auto& item : overrides) {
    apply_override(state->root, item);
  }
  return state;
}

std::shared_ptr<CaseState> parse_extended(const CaseNode& node, const std::filesystem::path& folder_of_case) {
  std::vector<std::string> names;
  const auto take = [&](const CaseNode& entry) {
    if (entry.kind != CaseNode::Kind::text) {
      throw InputError(node.place, node.key, "must be the name of a case file, or an array of such names");
    }
    names.push_back(std::get<std::string>(entry.value));
  };
  if (node.kind != CaseNode::Kind::array) take(node);
  for (const auto& entry : node.children) take(*entry);
  auto state = std::make_shared<CaseState>();
  state->path = node.place;
  state->root.kind = CaseNode::Kind::table;
  state->root.read = true;
  fill_from_extended(state->root, node.place == "--set" ? folder_of_case : node.folder, names,
                     {node.key, node.place, 0});
  return state;
}

std::shared_ptr<CaseState> parse_case_text(const std::string& text, const std::string& name) {
  auto state = std::make_shared<CaseState>();
  state->path = name;
  state->root.kind = CaseNode::Kind::table;
  fill(state->root, parse_toml(text, name), Origin{name, {}});
  state->root.read = true;
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
