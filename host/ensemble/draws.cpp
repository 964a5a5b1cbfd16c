#include "host/ensemble/draws.hpp"

#include <spdlog/fmt/fmt.h>

#include "host/packing/packings.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {

std::int64_t seed_of(const Case& input, std::size_t member) {
  return input.packing.seed + static_cast<std::int64_t>(member * count_of_packings(input.packing));
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
                               "biaxial_bvp, column or tunnel",
                               to_string(input.kind)));
  }
  if (input.material != MaterialKind::grains)
    refuse("material", fmt::format("is {}: without grains all members would be the same", to_string(input.material)));
  if (!input.packing.files.empty())
    refuse("packing.file", "names the packings: all members of an ensemble would be the same");
  if (!input.packing.seeds.empty()) {
    refuse("packing.seeds",
           "names the seeds: all members of an ensemble would be the same; packing.seed and packing.candidates leave "
           "them to draw");
  }
}

}  // namespace voussoir::host
