#include "host/ensemble/draws.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "host/packing/packings.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {

namespace {

/// Each region with grains must draw its packings by packing.seed.
void expect_draws_of_regions(const Case& input) {
  bool grains = false;
  for (std::size_t k = 0; k < input.scene.regions.size(); ++k) {
    const RegionCase& region = input.scene.regions[k];
    if (region.elastic) continue;
    grains = true;
    const PackingCase& packing = region.packing;
    const char* fault = !packing.files.empty()               ? "names its packings"
                        : !packing.seeds.empty()             ? "names its seeds"
                        : packing.seed != input.packing.seed ? "has a seed of its own"
                                                             : nullptr;
    if (fault == nullptr) continue;
    const std::string key = fmt::format("region[{}]", k);
    throw io::InputError(place_of(input, key), key,
                         fmt::format("{}: the members of an ensemble draw by packing.seed", fault));
  }
  if (!grains)
    throw io::InputError(place_of(input, "region"), "region", "has no grains: all members would be the same");
}

/// The number of seeds that one member draws: where regions have recipes of their own, all begin with packing.seed, so
/// that the largest number counts.
std::size_t seeds_of_a_member(const Case& input) {
  if (input.kind != CaseKind::scene) return count_of_packings(input.packing);
  std::size_t most = 1;
  for (const RegionCase& region : input.scene.regions) {
    if (!region.elastic) most = std::max(most, count_of_packings(region.packing));
  }
  return most;
}

}  // namespace

std::int64_t seed_of(const Case& input, std::size_t member) {
  return input.packing.seed + static_cast<std::int64_t>(member * seeds_of_a_member(input));
}

std::string member_name(std::size_t member) { return fmt::format("member_{:03}", member); }

std::string seed_override(const Case& input, std::size_t member) {
  return fmt::format("packing.seed={}", seed_of(input, member));
}

void expect_a_draw(const Case& input) {
  const auto refuse = [&](const char* key, const std::string& sentence) {
    throw io::InputError(place_of(input, key), key, sentence);
  };
  if (!runs_on_a_mesh(input.kind)) {
    refuse("kind", fmt::format("is {}: an ensemble needs a kind with a mesh, which draws its packings by packing.seed: "
                               "biaxial_bvp, column, tunnel or scene",
                               to_string(input.kind)));
  }
  if (input.material != MaterialKind::grains)
    refuse("material", fmt::format("is {}: without grains all members would be the same", to_string(input.material)));
  if (input.kind == CaseKind::scene) return expect_draws_of_regions(input);
  if (!input.packing.files.empty())
    refuse("packing.file", "names the packings: all members of an ensemble would be the same");
  if (!input.packing.seeds.empty()) {
    refuse("packing.seeds",
           "names the seeds: all members of an ensemble would be the same; packing.seed and packing.candidates leave "
           "them to draw");
  }
}

}  // namespace voussoir::host
