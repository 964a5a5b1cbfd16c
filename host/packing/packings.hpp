#pragma once
/// Packings of a case: made once, kept in the recipe's folder, chosen by least bias.

#include <functional>
#include <string>
#include <vector>

#include "host/packing/packed_rve.hpp"

namespace voussoir::host {

/// Receives a line for the log for each packing that is made or found; may be empty.
using PackingNote = std::function<void(const std::string&)>;

/// Whether a packing's bias is wanted: it costs as much as a biaxial test.
enum class Bias { measured, left };

/// The packings of these seeds, in their order: found in the recipe's folder, or made side by side and stored there. A
/// seed whose packing does not come to rest is noted and left out. If there are several packings and their bias is
/// wanted, it is measured (bias.hpp). A recipe that names a file has that one packing. Throws std::runtime_error when
/// no packing is left.
[[nodiscard]] std::vector<PackedRve> obtain_packings(const SoilCase& soil, const PackingCase& recipe,
                                                     std::span<const std::int64_t> seeds, const PackingNote& note = {},
                                                     Bias bias = Bias::measured);

/// The seeds that a recipe names: `seeds`, or `candidates` seeds from `seed` on.
[[nodiscard]] std::vector<std::int64_t> seeds_of(const PackingCase& recipe);

/// The packing with the least bias of those of the recipe's candidate seeds. One packing cloned to all points biases
/// tau_xy at all of them (method.md §4).
[[nodiscard]] PackedRve choose_packing(const SoilCase& soil, const PackingCase& recipe, const PackingNote& note = {});

}  // namespace voussoir::host
