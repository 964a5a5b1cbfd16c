#pragma once
/// Packings of a case: made once, kept in the recipe's folder, chosen by least bias.

#include <functional>
#include <string>
#include <vector>

#include "host/packing/packed_rve.hpp"

namespace voussoir::host {

/// A line for the log while packings are made or found; may be empty.
using PackingNote = std::function<void(const std::string&)>;

/// Whether a packing's bias is wanted: it costs as much as a biaxial test.
enum class Bias { measured, left };

/// The packings of these seeds, in their order: from the recipe's folder, or made side by side and stored there. A seed
/// that does not come to rest is noted and left out. Of several packings the bias is measured, if wanted: the largest
/// |tau_xy|/sigma_yy above 20 kPa in oedometric compression to 700 kPa. A recipe that names a file has that one
/// packing. Throws std::runtime_error when no packing is left.
[[nodiscard]] std::vector<PackedRve> obtain_packings(const SoilCase& soil, const PackingCase& recipe,
                                                     std::span<const std::int64_t> seeds, const PackingNote& note = {},
                                                     Bias bias = Bias::measured);

/// The seeds that a recipe names: `seeds`, or `candidates` seeds from `seed` on.
[[nodiscard]] std::vector<std::int64_t> seeds_of(const PackingCase& recipe);

/// Of the recipe's candidate seeds the packing with the least bias: one packing cloned everywhere biases tau_xy
/// everywhere (method.md §4).
[[nodiscard]] PackedRve choose_packing(const SoilCase& soil, const PackingCase& recipe, const PackingNote& note = {});

}  // namespace voussoir::host
