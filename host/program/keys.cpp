#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/case/key_reference.hpp"
#include "host/process/standard_streams.hpp"
#include "host/program/commands.hpp"
#include "host/sweep/sweep_file.hpp"
#include "io/input_error.hpp"
#include "io/key_reference.hpp"
#include "io/near_names.hpp"
#include "io/text_file.hpp"

namespace voussoir::host {
namespace {

constexpr const char* sweep_files = "sweep";  ///< in place of the name of a kind

io::KeyReference sweep_reference() { return io::join_kinds(sweep_files, {{sweep_files, keys_of_sweep()}}); }

/// What a name asks for.
struct AskedFor {
  std::vector<io::KeyReference> references;
  bool whole = true;  ///< all keys of some files; otherwise a key, or the keys of a table
};

/// The keys of a name that is no kind. Throws InputError where there is none, with the names that may be meant.
AskedFor keys_named(const std::string& name) {
  AskedFor asked{.references = {}, .whole = false};
  std::vector<std::string> known{sweep_files};
  for (const auto& [kind, kind_name] : case_kind_names) known.emplace_back(kind_name);
  for (const io::KeyReference& reference : {case_reference(), sweep_reference()}) {
    io::KeyReference part = io::part_named(reference, name);
    if (!part.keys.empty()) asked.references.push_back(std::move(part));
    std::ranges::copy(io::plain_names(reference), std::back_inserter(known));
  }
  if (!asked.references.empty()) return asked;
  const std::vector<std::string> near = io::near_names(name, known);
  throw io::InputError("keys", "",
                       fmt::format("{} is no kind of case, no table and no key{}", io::in_one_line(name),
                                   near.empty() ? "; `voussoir keys` lists them all"
                                                : fmt::format("; did you mean {}?", fmt::join(near, " or "))));
}

/// The keys of all files, of a kind of case, of sweep files, of a table, or one key. A kind goes before a table of its
/// name.
AskedFor references_of(const std::string& name) {
  if (name.empty()) return {.references = {case_reference(), sweep_reference()}};
  if (name == sweep_files) return {.references = {sweep_reference()}};
  for (const auto& [kind, known] : case_kind_names) {
    if (name == known) return {.references = {case_reference(kind)}};
  }
  return keys_named(name);
}

}  // namespace

Outcome command_keys(const std::optional<std::string>& name, KeyForm form) {
  if (name && name->empty()) throw io::InputError("keys", "", "the name is an empty text; leave it out for all keys");
  const std::string wanted = name.value_or("");
  const auto [references, whole] = references_of(wanted);
  switch (form) {
    case KeyForm::page:
      return print_answer(whole ? io::key_page(references) : io::key_sections(references));
    case KeyForm::schema:  // cases and sweep files have one each: without a name it is that of cases
      if (!whole)
        throw io::InputError("keys", "", "--json-schema is of a kind of case or of sweep files, not of " + wanted);
      return print_answer(io::key_schema(references.front()));
    case KeyForm::table:
      break;
  }
  return print_answer(io::key_table(references));
}

}  // namespace voussoir::host
