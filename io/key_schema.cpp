/// The schema of a sort of files. Tables and keys of all kinds are the properties; what a kind does not use is refused
/// by a rule for this kind, so that editors, which read properties rather than rules, complete every key.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/key_reference.hpp"
#include "io/units.hpp"

namespace voussoir::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* any_text = "^[^\\u0000-\\u001f\\u007f]*$";
constexpr int most_letters = 1000;

bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

/// A text that is a quantity. Its number has no sign where a limit says that it is not negative; further limits are
/// beyond a regular expression.
std::string pattern_of(const KeyInfo& info) {
  std::string symbols;
  for (const Unit& unit : units()) {
    if (unit.dimension == info.dimension && !unit.symbol.empty())
      symbols += fmt::format("{}{}", symbols.empty() ? "" : "|", unit.symbol);
  }
  const bool has_sign = info.at_least.empty() ? !info.above_zero : info.at_least.front() == '-';
  return fmt::format(R"(^[ \t]*{}([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?[ \t]*({}){}[ \t]*$)",
                     has_sign ? "-?" : "", symbols, info.dimension == Dimension::none ? "?" : "");
}

void add_limits(Json& schema, const KeyInfo& info) {
  const auto number = [&](const std::string& limit) {
    return info.type == KeyType::integer ? Json(std::stoll(limit)) : Json(parse_quantity(limit, info.dimension));
  };
  if (!info.at_least.empty()) schema["minimum"] = number(info.at_least);
  if (info.at_least.empty() && info.above_zero) schema["exclusiveMinimum"] = 0;
  if (!info.at_most.empty()) schema["maximum"] = number(info.at_most);
}

Json text_schema(const std::string& pattern) {
  Json schema{{"type", "string"}, {"pattern", any_text}, {"maxLength", most_letters}};
  if (!pattern.empty()) schema["allOf"] = Json::array({Json{{"pattern", fmt::format("^({})$", pattern)}}});
  return schema;
}

/// The schema of one value.
Json value_schema(const KeyInfo& info) {
  Json schema = Json::object();
  switch (info.type) {
    case KeyType::quantity:
      if (info.dimension == Dimension::none) {
        schema["type"] = {"number", "string"};
        add_limits(schema, info);
      } else {
        schema["type"] = "string";
      }
      schema["pattern"] = pattern_of(info);
      break;
    case KeyType::integer:
      schema["type"] = "integer";
      add_limits(schema, info);
      break;
    case KeyType::boolean:
      schema["type"] = "boolean";
      break;
    case KeyType::choice:
      schema["enum"] = info.choices;
      break;
    case KeyType::path:
      schema = text_schema("");
      schema["minLength"] = 1;
      break;
    case KeyType::text:
      schema = text_schema(info.pattern);
      break;
    case KeyType::place: {
      const Json length{{"type", "string"}, {"pattern", pattern_of(info)}};
      Json name = text_schema("");
      name["minLength"] = 1;
      schema["anyOf"] = {name, {{"type", "array"}, {"items", length}, {"minItems", 2}, {"maxItems", 2}}};
      break;
    }
    case KeyType::value:
      schema["type"] = {"number", "string", "boolean"};
      break;
    case KeyType::list_of_text:
      schema = {{"type", "array"}, {"minItems", 1}, {"items", {{"type", "string"}}}};
      break;
    case KeyType::table:
      break;
  }
  return schema;
}

Json list_of(const Json& items, const KeyInfo& info) {
  Json schema{{"type", "array"}, {"items", items}};
  if (info.least_entries > 0) schema["minItems"] = info.least_entries;
  if (info.most_entries > 0) schema["maxItems"] = info.most_entries;
  if (info.different) schema["uniqueItems"] = true;
  return schema;
}

/// One value, a list of them, or either.
Json one_or_list(const Json& one, const KeyInfo& info) {
  if (!info.list) return one;
  Json entry = one;
  if (info.type == KeyType::value) entry["type"].push_back("array");  // alone, an array is the list of the values
  Json list = list_of(entry, info);
  return info.or_one ? Json{{"anyOf", {one, list}}} : list;
}

std::string description_of(const ListedKey& listed, const KeyReference& reference) {
  std::string text = listed.info.help;
  if (!listed.info.default_words.empty()) text += fmt::format(" Default: {}.", listed.info.default_words);
  for (const auto& [preset, value] : listed.other_defaults)
    text += fmt::format(" Default of the preset {}: {}.", preset, without_quotes(value));
  if (listed.kinds.size() < reference.kinds.size())
    text += fmt::format(" Only kind {}.", fmt::join(listed.kinds, ", "));
  return text;
}

Json key_schema_of(const ListedKey& listed, const KeyReference& reference) {
  Json schema{{"description", description_of(listed, reference)}};
  schema.update(one_or_list(value_schema(listed.info), listed.info));
  if (!listed.info.fallback.empty() && listed.info.default_words.empty())
    schema["default"] = Json::parse(listed.info.fallback);
  if (listed.info.key == "kind" && reference.kinds.size() == 1) schema["const"] = reference.kinds.front();
  return schema;
}

/// The object that holds the keys of a table ("" for the whole file), with the tables in it.
Json object_of(const std::string& table, const KeyReference& reference) {  // NOLINT(misc-no-recursion)
  Json properties = Json::object(), required = Json::array(), named = Json::array();
  const auto add = [&](const KeyInfo& info, const Json& schema) {
    if (info.named_by_user)
      named.push_back(schema);
    else
      properties[last_part(info.key)] = schema;
  };
  for (const ListedKey& listed : reference.keys) {
    if (parent_of(listed.info.key) != table) continue;
    add(listed.info, key_schema_of(listed, reference));
    if (listed.info.required) required.push_back(last_part(listed.info.key));
  }
  for (const ListedKey& listed : reference.tables) {
    if (parent_of(listed.info.key) != table) continue;
    Json schema{{"description", description_of(listed, reference)}};
    schema.update(one_or_list(object_of(as_parent(listed.info), reference), listed.info));
    add(listed.info, schema);
  }
  Json object{{"type", "object"}, {"properties", properties}};
  object["additionalProperties"] = named.empty() ? Json(false) : Json{{"anyOf", named}};
  if (!required.empty() && !table.empty()) object["required"] = required;
  return object;
}

/// The properties that a kind refuses in a table, each `false`.
Json refused_by(const std::string& kind, const std::string& table,  // NOLINT(misc-no-recursion)
                const KeyReference& reference) {
  Json refused = Json::object();
  for (const ListedKey& listed : reference.keys) {
    if (parent_of(listed.info.key) == table && !contains(listed.kinds, kind))
      refused[last_part(listed.info.key)] = false;
  }
  for (const ListedKey& listed : reference.tables) {
    if (parent_of(listed.info.key) != table) continue;
    const std::string name = last_part(listed.info.key);
    if (!contains(listed.kinds, kind)) {
      refused[name] = false;
    } else if (const Json inner = refused_by(kind, as_parent(listed.info), reference); !inner.empty()) {
      refused[name] = {{"properties", inner}};
    }
  }
  return refused;
}

/// The rules beside the properties: what must be there in a file that takes no keys over, and what a kind refuses.
Json rules_of(const KeyReference& reference) {
  Json rules = Json::array(), required = Json::array();
  for (const ListedKey& listed : reference.keys) {
    if (parent_of(listed.info.key).empty() && listed.info.required) required.push_back(listed.info.key);
  }
  if (!required.empty())
    rules.push_back({{"if", {{"not", {{"required", {"extends"}}}}}}, {"then", {{"required", required}}}});
  for (const std::string& kind : reference.kinds) {
    const Json refused = refused_by(kind, "", reference);
    if (refused.empty()) continue;
    rules.push_back({{"if", {{"properties", {{"kind", {{"const", kind}}}}}, {"required", {"kind"}}}},
                     {"then", {{"properties", refused}}}});
  }
  return rules;
}

}  // namespace

std::string key_schema(const KeyReference& reference) {
  Json schema{
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"title", fmt::format("Voussoir {} file", reference.title)},
      {"description", "Made by `voussoir keys --json-schema`; docs/reference/keys.md has the same keys as a page."}};
  schema.update(object_of("", reference));
  if (const Json rules = rules_of(reference); !rules.empty()) schema["allOf"] = rules;
  return schema.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace voussoir::io
