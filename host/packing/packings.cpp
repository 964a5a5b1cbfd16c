#include "host/packing/packings.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "host/packing/bias.hpp"
#include "host/packing/law_range.hpp"
#include "host/packing/packing_locks.hpp"
#include "host/packing/recipe.hpp"
#include "host/packing/stored_packing.hpp"
#include "host/process/exit_code.hpp"
#include "io/atomic_file.hpp"
#include "io/hash.hpp"
#include "io/input_error.hpp"
#include "io/packing_file.hpp"

namespace voussoir::host {

namespace {

std::string table_line(const PackedRve& rve) {
  std::string bias = std::isnan(rve.bias) ? "" : fmt::format("  bias {:.4f}", rve.bias);
  if (rve.mean_overlap > most_mean_overlap) {
    bias += fmt::format(
        "  warning: the mean overlap of {:.1f} % of r_i + r_j is beyond the {:.0f} % that the contact law "
        "is good for",
        100 * rve.mean_overlap, 100 * most_mean_overlap);
  }
  return fmt::format(
      "seed {:5d}  grains {:5d}  mu_t {:.3f}  void ratio {:.4f}  p {:.1f} Pa  coordination {:.3f}  unbalanced {:.1e}{}",
      rve.seed, rve.packing.size(), rve.consolidation_friction, rve.void_ratio, rve.pressure, rve.coordination,
      rve.unbalanced, bias);
}

void keep(const SoilCase& soil, const PackingCase& recipe, const PackedRve& rve) {
  const std::string text = recipe_text(soil, recipe, rve.seed);
  const std::string fingerprint = io::fingerprint_of(text);
  io::save_packing(io::packing_path(recipe.folder, fingerprint), stored_packing(rve, soil, text, fingerprint));
}

std::optional<PackedRve> find(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed) {
  const std::string text = recipe_text(soil, recipe, seed);
  const auto file = io::find_packing(recipe.folder, io::fingerprint_of(text));
  // Two recipes may have one fingerprint; the recipe itself tells them apart.
  const auto kept = file ? file->labels.find("recipe") : std::map<std::string, std::string>::const_iterator{};
  if (file && (kept == file->labels.end() || kept->second != text)) return std::nullopt;
  auto rve = file ? restored_packing(*file, soil) : std::nullopt;
  return rve && rve->packing.size() == recipe.grains ? rve : std::nullopt;
}

PackingLock lock_of(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed, const PackingNote& note) {
  return {stored_path(soil, recipe, seed), seed, note};
}

/// True for a packing that cannot be one of grains. An older version may have stored such packings.
bool is_refused(const PackedRve& rve, const PackingNote& note) {
  const std::string fault = interpenetration(rve);
  if (!fault.empty() && note)
    note({fmt::format("packing of seed {} is refused and left out: {}", rve.seed, fault), true});
  return !fault.empty();
}

/// Makes the packings of these seeds side by side. Those that do not come to rest are noted and left out.
std::vector<PackedRve> make_resting(const SoilCase& soil, const PackingCase& recipe,
                                    std::span<const std::int64_t> seeds, const PackingNote& note) {
  std::vector<PackedRve> out;
  for (PackedRve& rve : make_packings(soil, recipe, seeds)) {
    if (rve.status != kernels::RveStatus::converged) {
      if (note)
        note({fmt::format("packing of seed {} does not come to rest ({}) and is left out", rve.seed,
                          kernels::name_of(rve.status)),
              true});
    } else if (!is_refused(rve, note)) {
      out.push_back(std::move(rve));
    }
  }
  return out;
}

void make_and_keep(const SoilCase& soil, const PackingCase& recipe, std::span<const std::int64_t> seeds,
                   const PackingNote& note) {
  for (const PackedRve& rve : make_resting(soil, recipe, seeds, note)) keep(soil, recipe, rve);
}

void require_one(const std::vector<PackedRve>& found, const PackingCase& recipe, std::span<const std::int64_t> seeds) {
  if (!found.empty()) return;
  throw NoEquilibrium(fmt::format("none of the {} packings of this recipe (first seed {}) comes to rest at {:.4g} kPa",
                                  seeds.size(), seeds.empty() ? 0 : seeds.front(), recipe.pressure * 1e-3));
}

/// Makes the packings that are missing. Those at which another process is at work are waited for at the end, when this
/// process holds no lock itself, so that two processes cannot wait for one another. Returns the seeds that were made
/// here.
std::vector<std::int64_t> make_missing(const SoilCase& soil, const PackingCase& recipe,
                                       std::span<const std::int64_t> seeds, const PackingNote& note) {
  std::vector<std::int64_t> here, elsewhere;
  {
    std::vector<PackingLock> held;
    for (const std::int64_t seed : seeds) {
      if (find(soil, recipe, seed)) continue;
      std::filesystem::create_directories(recipe.folder);
      PackingLock lock = lock_of(soil, recipe, seed, note);
      if (!lock.take()) {
        elsewhere.push_back(seed);
      } else if (!find(soil, recipe, seed)) {  // it may have been finished in between
        held.push_back(std::move(lock));
        here.push_back(seed);
      }
    }
    make_and_keep(soil, recipe, here, note);
  }
  for (const std::int64_t seed : elsewhere) {
    PackingLock lock = lock_of(soil, recipe, seed, note);
    lock.wait();
    if (find(soil, recipe, seed)) continue;  // otherwise the other process has died, or its packing has found no rest
    make_and_keep(soil, recipe, std::span(&seed, 1), note);
    here.push_back(seed);
  }
  return here;
}

/// Measures the bias of the packings without one and stores it with them. Locks are taken in the order of the seeds by
/// all processes, so that two cannot wait for one another.
void measure_bias(const SoilCase& soil, const PackingCase& recipe, std::vector<PackedRve>& rves,
                  const PackingNote& note) {
  std::vector<PackedRve*> ascending;
  for (PackedRve& rve : rves) ascending.push_back(&rve);
  std::sort(ascending.begin(), ascending.end(),
            [](const PackedRve* a, const PackedRve* b) { return a->seed < b->seed; });
  std::vector<PackingLock> held;
  std::vector<PackedRve> unknown;
  std::vector<PackedRve*> place;
  for (PackedRve* rve : ascending) {
    if (!std::isnan(rve->bias)) continue;
    PackingLock lock = lock_of(soil, recipe, rve->seed, note);
    lock.wait();
    if (const auto stored = find(soil, recipe, rve->seed)) rve->bias = stored->bias;
    if (!std::isnan(rve->bias)) continue;
    held.push_back(std::move(lock));
    unknown.push_back(*rve);
    place.push_back(rve);
  }
  const std::vector<double> biases = biases_of(unknown);
  for (std::size_t k = 0; k < place.size(); ++k) {
    place[k]->bias = biases[k];
    keep(soil, recipe, *place[k]);
  }
}

PackedRve stored_state(const SoilCase& soil, const std::filesystem::path& file, const PackingNote& note) {
  const io::Packing read = io::load_packing(file);
  auto rve = restored_packing(read, soil);
  if (!rve) {  // the file has changed since the case was accepted
    throw io::InputError("packing.file", file.string(),
                         "is not a complete packing of this program and its contact law: " + fault_of_state(read));
  }
  if (const std::string fault = interpenetration(*rve); !fault.empty() && note) {
    note(fmt::format("warning: the state in {}: {}", file.string(), fault));
  }
  if (note) note("packing read:  " + table_line(*rve));
  return std::move(*rve);
}

/// The packings in the recipe's files, in their order. Those of another code come to rest side by side.
std::vector<PackedRve> packings_of_files(const SoilCase& soil, const PackingCase& recipe, const PackingNote& note) {
  if (recipe.has_state()) return {stored_state(soil, recipe.files.front(), note)};
  std::vector<PackedRve> rves = settle_foreign_packings(soil, recipe);
  for (std::size_t k = 0; k < rves.size(); ++k) {
    const std::string name = recipe.files[k].string();
    if (rves[k].status != kernels::RveStatus::converged) {
      throw NoEquilibrium(fmt::format("{} does not come to rest: {}", name, kernels::name_of(rves[k].status)));
    }
    if (const std::string fault = interpenetration(rves[k]); !fault.empty()) {
      throw std::runtime_error(fmt::format("{}: {}", name, fault));
    }
    if (note) {
      note(fmt::format("packing read:  {}{}  (packing.grains, seeds and density of the recipe are not used)",
                       table_line(rves[k]), rves.size() > 1 ? "  " + name : std::string()));
    }
  }
  return rves;
}

}  // namespace

std::filesystem::path stored_path(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed) {
  return io::packing_path(recipe.folder, io::fingerprint_of(recipe_text(soil, recipe, seed)));
}

std::vector<std::int64_t> seeds_of(const PackingCase& recipe) {
  std::vector<std::int64_t> seeds = recipe.seeds;
  for (int k = 0; recipe.seeds.empty() && k < recipe.candidates; ++k) seeds.push_back(recipe.seed + k);
  return seeds;
}

std::size_t count_of_packings(const PackingCase& recipe) {
  return recipe.files.empty() ? seeds_of(recipe).size() : recipe.files.size();
}

std::vector<PackedRve> obtain_packings(const SoilCase& soil, const PackingCase& recipe,
                                       std::span<const std::int64_t> seeds, const PackingNote& note, Bias bias) {
  if (!recipe.files.empty()) return packings_of_files(soil, recipe, note);
  std::filesystem::create_directories(recipe.folder);
  io::remove_leftovers(recipe.folder);
  const std::vector<std::int64_t> made_here = make_missing(soil, recipe, seeds, note);
  std::vector<PackedRve> out;
  for (const std::int64_t seed : seeds) {
    auto rve = find(soil, recipe, seed);
    if (rve && !is_refused(*rve, note)) out.push_back(std::move(*rve));
  }
  require_one(out, recipe, seeds);
  if (bias == Bias::measured && out.size() > 1) measure_bias(soil, recipe, out, note);
  for (const PackedRve& rve : out) {
    const bool made = std::find(made_here.begin(), made_here.end(), rve.seed) != made_here.end();
    if (note) note((made ? "packing made:  " : "packing found: ") + table_line(rve));
  }
  return out;
}

std::vector<PackedRve> fresh_packings(const SoilCase& soil, const PackingCase& recipe,
                                      std::span<const std::int64_t> seeds, const PackingNote& note) {
  std::vector<PackedRve> out = make_resting(soil, recipe, seeds, note);
  require_one(out, recipe, seeds);
  return out;
}

namespace {

/// The `count` packings with the least bias of the recipe's candidates, the least biased first. Where all of them are
/// needed, they stay in their order and their bias does not have to be measured.
std::vector<PackedRve> least_biased(const SoilCase& soil, const PackingCase& recipe, std::size_t count,
                                    const PackingNote& note) {
  const bool all_needed = count_of_packings(recipe) == count;
  std::vector<PackedRve> all = obtain_packings(soil, recipe, seeds_of(recipe), note,
                                               all_needed ? Bias::left : Bias::measured);
  if (all.size() < count) {
    throw NoEquilibrium(
        fmt::format("packing.variety = {} asks for more packings than the {} of this recipe that come to rest (of {}); "
                    "a larger packing.candidates gives more to choose from",
                    count, all.size(), count_of_packings(recipe)));
  }
  if (all_needed) return all;
  if (!recipe.files.empty()) {
    const std::vector<double> biases = biases_of(all);
    for (std::size_t k = 0; k < all.size(); ++k) all[k].bias = biases[k];
  }
  std::stable_sort(all.begin(), all.end(), [](const PackedRve& a, const PackedRve& b) {
    return a.bias != b.bias ? a.bias < b.bias : a.seed < b.seed;
  });
  all.erase(all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
  for (std::size_t k = 0; note && k < count; ++k) {
    note(fmt::format("packing of seed {} is used{}: its largest |tau_xy|/sigma_yy in oedometric compression is {:.4f}",
                     all[k].seed, count > 1 ? fmt::format(" as packing {}", k) : std::string(), all[k].bias));
  }
  return all;
}

}  // namespace

PackedRve choose_packing(const SoilCase& soil, const PackingCase& recipe, const PackingNote& note) {
  return std::move(least_biased(soil, recipe, 1, note).front());
}

PackingMix choose_packings(const SoilCase& soil, const PackingCase& recipe, std::size_t n, const PackingNote& note) {
  return mix(least_biased(soil, recipe, static_cast<std::size_t>(recipe.variety), note), n, recipe.seed);
}

}  // namespace voussoir::host
