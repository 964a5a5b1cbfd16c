#pragma once
/// The packings of a case. They are made once and kept in the recipe's folder; the one with the least bias is chosen.

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/packing/variety.hpp"

namespace voussoir::host {

/// A line for the log. It is made of a text and used as one.
struct PackingLine {
  // NOLINTNEXTLINE(google-explicit-constructor): most lines are a text and nothing else
  PackingLine(std::string line, bool is_left_out = false) : text(std::move(line)), left_out(is_left_out) {}
  // NOLINTNEXTLINE(google-explicit-constructor): receivers may take a text
  operator const std::string&() const { return text; }

  std::string text;
  bool left_out = false;  ///< the line is the reason why a packing is left out
};

/// A function that receives a line for each packing that is made or found; it may be empty.
using PackingNote = std::function<void(const PackingLine&)>;

/// Says whether the bias of packings is measured, which costs as much as a biaxial test.
enum class Bias { measured, left };

/// The packings of these seeds, in their order: found in the recipe's folder, or made side by side and stored there. A
/// seed whose packing does not come to rest is noted and left out. With Bias::measured the bias is measured (bias.hpp)
/// where there are several packings. A recipe that names files has the packings in these files. Where several
/// processes ask for one packing, one makes it and the others wait (packing_locks.hpp). Throws NoEquilibrium when no
/// packing is left, Interrupted where a request to stop arrives during the wait.
[[nodiscard]] std::vector<PackedRve> obtain_packings(const SoilCase& soil, const PackingCase& recipe,
                                                     std::span<const std::int64_t> seeds, const PackingNote& note = {},
                                                     Bias bias = Bias::measured);

/// The packings of these seeds, made side by side and not stored. A seed whose packing does not come to rest is noted
/// and left out. Throws NoEquilibrium when no packing is left.
[[nodiscard]] std::vector<PackedRve> fresh_packings(const SoilCase& soil, const PackingCase& recipe,
                                                    std::span<const std::int64_t> seeds, const PackingNote& note = {});

/// The file in the recipe's folder that holds the packing of a seed, or will hold it.
[[nodiscard]] std::filesystem::path stored_path(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed);

/// The seeds that a recipe names: `seeds`, or `candidates` seeds from `seed` on.
[[nodiscard]] std::vector<std::int64_t> seeds_of(const PackingCase& recipe);

/// The number of packings at one pressure that a recipe makes or reads.
[[nodiscard]] std::size_t count_of_packings(const PackingCase& recipe);

/// The packing with the least bias of those of the recipe's candidate seeds. One packing cloned to all points biases
/// tau_xy at all of them.
[[nodiscard]] PackedRve choose_packing(const SoilCase& soil, const PackingCase& recipe, const PackingNote& note = {});

/// The packings of `n` Gauss points: the `recipe.variety` packings with the least bias of those of the recipe's
/// candidate seeds, spread by `recipe.seed`. Throws NoEquilibrium where fewer packings come to rest, because a
/// result whose variety is smaller than the case says would pass for a surer one than it is.
[[nodiscard]] PackingMix choose_packings(const SoilCase& soil, const PackingCase& recipe, std::size_t n,
                                         const PackingNote& note = {});

}  // namespace voussoir::host
