#pragma once
/// The way from a case file to a case. Each table has its reader in a file of this folder; here values of different
/// tables are compared with each other.

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "io/key_info.hpp"

namespace voussoir::host {

/// The keys and tables that change no number of a result and may differ where a run is resumed. A preset acts only
/// through the values that it gives to other keys. A stored mesh is the one that would be generated, and a run that is
/// resumed compares its mesh with that of its start.
inline const std::array<std::string, 6> keys_without_results{"title",         "output",     "packing.folder",
                                                             "engine.preset", "engine.isa", "ground.mesh_file"};

/// Reads, overrides (`table.key=value`) and validates a case. Throws io::InputError (file, line, key) where
/// the input is wrong: unknown keys, wrong units, values outside their limits, values that do not fit together.
[[nodiscard]] Case load_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same for a case that is given as text. @param name stands for the file in messages
[[nodiscard]] Case case_of_text(const std::string& text, const std::string& name);

/// All keys and tables of a kind with their types, defaults and limits, as the readers of the tables state them.
/// @param more lines of a case whose defaults are wanted, such as "[engine]\npreset = \"fast\"\n"
[[nodiscard]] io::KeyList keys_of(CaseKind kind, const std::string& more = {});

}  // namespace voussoir::host
