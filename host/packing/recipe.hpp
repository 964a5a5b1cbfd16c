#pragma once
/// Making packings from a recipe: loose random discs, isotropic consolidation with the temporary
/// friction, then the working friction at the same pressure. The same recipe and seed give the same packing, bit for
/// bit.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "host/packing/packed_rve.hpp"

namespace voussoir::host {

/// Makes the packings of several seeds side by side in one batch. A packing does not depend on the other seeds. The
/// status of a packing says whether it has come to rest.
[[nodiscard]] std::vector<PackedRve> make_packings(const SoilCase& soil, const PackingCase& recipe,
                                                   std::span<const std::int64_t> seeds);

/// The packings of another code (`recipe.files`, see io::load_packing_csv) with this soil's grains: contacts are made
/// from the overlaps, without history, and the packings come to rest at `recipe.pressure`. Throws std::runtime_error on
/// an unusable file.
[[nodiscard]] std::vector<PackedRve> settle_foreign_packings(const SoilCase& soil, const PackingCase& recipe);

/// All values that decide a packing's numbers, as text. Equal texts give equal packings.
[[nodiscard]] std::string recipe_text(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed);

}  // namespace voussoir::host
