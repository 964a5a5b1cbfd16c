#pragma once
/// Making packings from a recipe (method.md §3): loose random discs, isotropic consolidation with the temporary
/// friction, then the working friction at the same pressure. Same recipe and seed: same packing, bit for bit.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "host/packing/packed_rve.hpp"

namespace voussoir::host {

/// The packings of several seeds, side by side in one batch; each is the same whatever other seeds it is made with. One
/// that does not come to rest says so in its status.
[[nodiscard]] std::vector<PackedRve> make_packings(const SoilCase& soil, const PackingCase& recipe,
                                                   std::span<const std::int64_t> seeds);

/// The packing of another code (`recipe.file`, see io::load_packing_csv) with this soil's grains: contacts are rebuilt
/// from the overlaps, without history, then it comes to rest at `recipe.pressure`. Throws std::runtime_error on an
/// unusable file.
[[nodiscard]] PackedRve settle_foreign_packing(const SoilCase& soil, const PackingCase& recipe);

/// Everything that decides the packing's numbers, as text; equal texts give equal packings.
[[nodiscard]] std::string recipe_text(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed);

}  // namespace voussoir::host
