#pragma once
/// The keys that a stored packing or state was made with, and their comparison with a case. docs/reference/files.md
/// says where they are kept.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "host/case/case.hpp"
#include "io/case_compare.hpp"
#include "io/packing_file.hpp"

namespace voussoir::host {

/// Keys with their values as a user would write them, such as {"soil.modulus", "3 GPa"}.
using KeyTexts = std::vector<std::pair<std::string, std::string>>;

/// The keys of a soil that decide how its grains answer, and their sizes. The density is not among them: no number
/// depends on it.
[[nodiscard]] KeyTexts soil_keys(const SoilCase& soil);

/// The keys of [engine] that decide how accurately a state was reached. They may differ where a state is read, because
/// the state is looked at anew with the case's own settings.
[[nodiscard]] KeyTexts engine_keys(const EngineCase& engine);

/// The soil that a packing file says it was made with: its labels "soil.*", else its label "recipe", else the numbers
/// of a meta file of Yade. Empty where the file says nothing.
[[nodiscard]] KeyTexts soil_keys_of(const io::Packing& file);

/// The labels "engine.*" of a packing file.
[[nodiscard]] KeyTexts engine_keys_of(const io::Packing& file);

/// The keys of `theirs` whose values differ in `ours`, or that `ours` lacks.
[[nodiscard]] std::vector<io::KeyDifference> differences(const KeyTexts& ours, const KeyTexts& theirs);

}  // namespace voussoir::host
