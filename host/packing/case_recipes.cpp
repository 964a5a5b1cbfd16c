#include "host/packing/case_recipes.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <cstddef>

namespace voussoir::host {

std::string SoilRecipe::place() const {
  if (regions.empty()) return "";
  return fmt::format("region{} {}", regions.size() == 1 ? "" : "s", fmt::join(regions, ", "));
}

std::vector<SoilRecipe> recipes_of(const Case& input) {
  std::vector<SoilRecipe> all;
  if (runs_on_a_mesh(input.kind) && input.material != MaterialKind::grains) return all;
  if (input.kind != CaseKind::scene) return {{&input.soil, &input.packing, ""}};
  for (std::size_t k = 0; k < input.scene.regions.size(); ++k) {
    const RegionCase& region = input.scene.regions[k];
    if (!region.elastic) all.push_back({&region.soil, &region.packing, fmt::format("region[{}].", k), region.names});
  }
  return all;
}

bool has_grains(const Case& input) { return !recipes_of(input).empty(); }

}  // namespace voussoir::host
