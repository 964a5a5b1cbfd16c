#include <optional>
#include <string>
#include <vector>

#include "host/case/key_reference.hpp"
#include "host/process/standard_streams.hpp"
#include "host/program/commands.hpp"
#include "host/sweep/sweep_file.hpp"
#include "io/input_error.hpp"
#include "io/key_reference.hpp"
#include "io/text_file.hpp"

namespace voussoir::host {
namespace {

constexpr const char* sweep_files = "sweep";  ///< in place of the name of a kind

io::KeyReference sweep_reference() { return io::join_kinds(sweep_files, {{sweep_files, keys_of_sweep()}}); }

/// What the name asks for: the keys of all files, of a kind of case, or of sweep files.
std::vector<io::KeyReference> references_of(const std::string& name) {
  if (name.empty()) return {case_reference(), sweep_reference()};
  if (name == sweep_files) return {sweep_reference()};
  std::string names;
  for (const auto& [kind, known] : case_kind_names) {
    if (name == known) return {case_reference(kind)};
    names += std::string(known) + ", ";
  }
  throw io::InputError("keys", "", "the kind must be one of " + names + sweep_files + ", is " + io::in_one_line(name));
}

}  // namespace

Outcome command_keys(const std::optional<std::string>& kind, KeyForm form) {
  if (kind && kind->empty()) throw io::InputError("keys", "", "the kind is an empty text; leave it out for all kinds");
  const std::vector<io::KeyReference> references = references_of(kind.value_or(""));
  switch (form) {
    case KeyForm::page:
      return print_answer(io::key_page(references));
    case KeyForm::schema:  // cases and sweep files have one each: without a name it is that of cases
      return print_answer(io::key_schema(references.front()));
    case KeyForm::table:
      break;
  }
  return print_answer(io::key_table(references));
}

}  // namespace voussoir::host
