/// The page of all keys: a section for each table, in which a key has its default, its values and its sentences.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>

#include "io/key_reference.hpp"
#include "io/units.hpp"

namespace voussoir::io {
namespace {

constexpr const char* introduction =
    R"(# Every key of case files and sweep files

This page lists every key that the program reads, with its default, the values that it takes, and what it does to the
result. It is made by `voussoir keys --markdown` from the program itself. `voussoir check CASE.toml` prints every key
of one case with the value that it has there. The [glossary](glossary.md) explains the words of the method.

A case is a text file in the format [TOML](https://toml.io). Its key `kind` says what is computed; every other key has
a default or may be left out, unless its default here is "must be given".

```toml
kind = "tunnel"

[ground]
diameter = "6 m"      # a quantity stands in quotes, with its unit
cover_ratio = 2       # a plain number has no unit

[[soil.class]]        # double brackets begin one entry of a list of tables
size_to = "4 mm"
```

)";

constexpr const char* how_values =
    R"(A key that does not exist, a value of another dimension and a value beyond its limits are errors, with the line of the
file. On the command line, `--set ground.diameter="6 m"` replaces a value of the file.

)";

constexpr const char* how_editors =
    R"(## An editor that completes and checks

The program writes the same keys as JSON schemas: [case.schema.json](case.schema.json) for cases and
[sweep.schema.json](sweep.schema.json) for sweep files (`voussoir keys --json-schema`, `voussoir keys sweep
--json-schema`). An editor with support for such schemas offers the keys and their values while one types, shows the
sentences of this page, and marks what is wrong. In Visual Studio Code, install the extension "Even Better TOML" and
write as the first line of the case, with the way to the schema relative to the case:

```toml
#:schema ../../docs/reference/case.schema.json
```

The command `taplo check case.toml` of the program [Taplo](https://taplo.tamasfe.dev), on which this extension is
built, checks the same in a terminal. A schema does not see everything: limits of quantities with a unit, relations
between two keys and files that do not exist are found by `voussoir check` alone.

)";

constexpr const char* about_sweeps =
    R"(A sweep file names many runs: those of grids, whose axes are keys of the case, and single ones. Names in capital
letters below stand for a name that the user chooses.

```toml
base = "../tunnel_quick/case.toml"

[grid]
"ground.cover_ratio" = [2, 3, 4]
members = 4

[grid.soil]
dense = "packing.consolidation_friction=0"
loose = ["packing.consolidation_friction=0.45", "ground.unit_weight=18 kN/m3"]

[[run]]
name = "softer"
set = ["soil.modulus=1 GPa"]
```

)";

constexpr std::size_t columns = 120;

/// Prose in lines of a page's width.
std::string wrapped(const std::string& text) {
  std::string out, line;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (!line.empty() && line.size() + 1 + word.size() > columns) out += std::exchange(line, "") + "\n";
    line += (line.empty() ? "" : " ") + word;
    begin = end + 1;
  }
  return out + line + "\n";
}

/// Names of pages become links, which work from docs/reference.
std::string with_links(const std::string& text) {
  static const std::regex pages(R"(docs/([a-z-]+)/([a-z_]+)\.md)"), cases(R"(cases/([a-z_0-9]+)\b)");
  return std::regex_replace(std::regex_replace(text, cases, "[$&](../../cases/$1/README.md)"), pages,
                            "[$&](../$1/$2.md)");
}

std::string as_code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

std::vector<std::string> as_codes(const std::vector<std::string>& texts) {
  std::vector<std::string> codes;
  for (const std::string& text : texts) codes.push_back(as_code(text));
  return codes;
}

std::string units_table() {
  std::string out = "| quantity | units |\n|---|---|\n";
  using enum Dimension;
  for (const Dimension dimension : {length, pressure, unit_weight, density, angle, none}) {
    std::vector<std::string> symbols;
    for (const Unit& unit : units()) {
      if (unit.symbol == "\u03bcm") continue;  // looks the same as the micro sign
      if (unit.dimension == dimension && !unit.symbol.empty()) symbols.push_back(as_code(std::string(unit.symbol)));
    }
    if (dimension == none)
      out += "| number without a dimension | no unit, as in `0.25`, or `%` in quotes, as in `\"25 %\"` |\n";
    else
      out += fmt::format("| {} | {} |\n", dimension_name(dimension), fmt::join(symbols, ", "));
  }
  return out + "\n";
}

std::string type_of(const KeyInfo& info) {
  switch (info.type) {
    case KeyType::quantity:
      return info.dimension == Dimension::none ? "number" : std::string(dimension_name(info.dimension));
    case KeyType::boolean:
      return "`true` or `false`";
    case KeyType::choice:
      return fmt::format("{}", fmt::join(as_codes(info.choices), ", "));
    case KeyType::path:
      return "file";
    case KeyType::place:
      return "name of a point, or two lengths";
    case KeyType::value:
      return "value";
    case KeyType::list_of_text:
      return "lists of texts";
    default:
      return std::string(name_of(info.type));
  }
}

std::string values_of(const KeyInfo& info) {
  std::string text = type_of(info);
  if (info.or_one)
    text += ", or a list of them";
  else if (info.list)
    text = fmt::format("list: {}", text);
  if (!info.at_least.empty() && !info.at_most.empty()) text += fmt::format(", {} to {}", info.at_least, info.at_most);
  constexpr std::size_t no_limit_to_tell = 100'000;
  if (info.least_entries > 1 || (info.most_entries > 0 && info.most_entries < no_limit_to_tell)) {
    text += info.least_entries == info.most_entries ? fmt::format("; {} entries", info.most_entries)
            : info.least_entries == 0               ? fmt::format("; at most {} entries", info.most_entries)
                                      : fmt::format("; {} to {} entries", info.least_entries, info.most_entries);
  }
  return text + (info.different ? ", no two the same" : "");
}

std::string default_of(const ListedKey& listed) {
  const KeyInfo& info = listed.info;
  if (info.required) return "must be given";
  if (!info.default_words.empty()) return info.default_words;
  if (info.fallback == "[]") return "empty list";
  if (info.fallback.empty()) return "none";
  std::string text = as_code(info.list ? info.fallback : without_quotes(info.fallback));
  for (const auto& [preset, value] : listed.other_defaults)
    text += fmt::format("; `{}`: {}", preset, as_code(without_quotes(value)));
  return text;
}

/// "kind `a`", "kinds `a`, `b`".
std::string kinds_in(const std::vector<std::string>& kinds) {
  return fmt::format("kind{} {}", kinds.size() > 1 ? "s" : "", fmt::join(as_codes(kinds), ", "));
}

std::string kinds_note(const ListedKey& listed, const std::vector<std::string>& others) {
  if (listed.kinds == others) return "";
  return fmt::format("Only {}. ", kinds_in(listed.kinds));
}

/// The table of the keys in one table of the file; empty where it has none.
std::string rows_of(const std::string& table, const std::vector<std::string>& kinds, const KeyReference& reference) {
  std::string rows, named;  // keys whose names the user chooses come last
  for (const ListedKey& listed : reference.keys) {
    if (parent_of(listed.info.key) != table || !listed.info.like.empty()) continue;
    (listed.info.named_by_user ? named : rows) += fmt::format(
        "| {} | {} | {} | {}{} |\n", as_code(last_part(listed.info.key)), default_of(listed), values_of(listed.info),
        kinds_note(listed, kinds), with_links(listed.info.help));
  }
  rows += named;
  return rows.empty() ? "" : "| key | default | values | what it is and does |\n|---|---|---|---|\n" + rows + "\n";
}

/// "[soil]", "[[soil.class]]", "[grid.NAME]".
std::string heading_of(const KeyInfo& table) {
  std::string name = table.key;
  for (std::size_t at = name.find("[]"); at != std::string::npos; at = name.find("[]")) name.erase(at, 2);
  return table.list ? fmt::format("[[{}]]", name) : fmt::format("[{}]", name);
}

std::string section_of(const ListedKey& table, const KeyReference& reference) {
  std::string text = with_links(table.info.help);
  if (reference.kinds.size() > 1) {
    const bool all = table.kinds == reference.kinds;
    text += all ? " All kinds use it." : fmt::format(" Used by {}.", kinds_in(table.kinds));
  }
  return fmt::format("### `{}`\n\n{}\n{}", heading_of(table.info), wrapped(text),
                     rows_of(as_parent(table.info), table.kinds, reference));
}

/// Which kind reads which table.
std::string kinds_table(const KeyReference& reference) {
  std::string out = fmt::format("| table | {} |\n|---|", fmt::join(as_codes(reference.kinds), " | "));
  for (std::size_t k = 0; k < reference.kinds.size(); ++k) out += ":-:|";
  out += "\n";
  for (const ListedKey& table : reference.tables) {
    if (!table.info.like.empty()) continue;
    out += fmt::format("| `{}` |", heading_of(table.info));
    for (const std::string& kind : reference.kinds) {
      const bool used = std::find(table.kinds.begin(), table.kinds.end(), kind) != table.kinds.end();
      out += used ? " x |" : "  |";
    }
    out += "\n";
  }
  return out + "\n";
}

/// The tables of the keys, under the heading of the file; `about` stands between them.
std::string part_of(const KeyReference& reference, const std::string& about) {
  std::string out = fmt::format("## Keys of {} files\n\n", reference.title) + about;
  const std::string top = rows_of("", reference.kinds, reference);
  if (!top.empty()) out += "### At the top of the file\n\nThese keys stand before the first table.\n\n" + top;
  for (const ListedKey& table : reference.tables) {
    if (table.info.like.empty()) out += section_of(table, reference);
  }
  return out;
}

/// What stands before the tables of a whole reference.
std::string about(const KeyReference& reference) {
  const bool has_kinds = !reference.kinds.empty() && reference.title == "case";
  return (has_kinds ? "" : about_sweeps) + (reference.kinds.size() > 1 ? kinds_table(reference) : "");
}

std::string without_last_line(std::string out) {
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

}  // namespace

std::string key_sections(const std::vector<KeyReference>& references) {
  std::string out;
  for (const KeyReference& reference : references) out += part_of(reference, "");
  return without_last_line(out);
}

std::string key_page(const std::vector<KeyReference>& references) {
  std::string out;
  if (references.size() > 1) out += introduction + units_table() + how_values + how_editors;
  for (const KeyReference& reference : references) out += part_of(reference, about(reference));
  return without_last_line(out);
}

}  // namespace voussoir::io
