#include "host/packing/packings.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "host/packing/bias.hpp"
#include "host/packing/law_range.hpp"
#include "host/packing/recipe.hpp"
#include "host/packing/stored_packing.hpp"
#include "io/hash.hpp"
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
  std::filesystem::create_directories(recipe.folder);
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

/// Measures the bias of the packings without one and stores it with them.
void measure_bias(const SoilCase& soil, const PackingCase& recipe, std::vector<PackedRve>& rves) {
  std::vector<PackedRve> unknown;
  for (const PackedRve& rve : rves) {
    if (std::isnan(rve.bias)) unknown.push_back(rve);
  }
  const std::vector<double> biases = biases_of(unknown);
  for (PackedRve& rve : rves) {
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      if (unknown[k].seed != rve.seed) continue;
      rve.bias = biases[k];
      keep(soil, recipe, rve);
    }
  }
}

/// True for a packing that cannot be one of grains. An older version may have stored such packings.
bool is_refused(const PackedRve& rve, const PackingNote& note) {
  const std::string fault = interpenetration(rve);
  if (!fault.empty() && note) note(fmt::format("packing of seed {} is refused and left out: {}", rve.seed, fault));
  return !fault.empty();
}

}  // namespace

std::vector<std::int64_t> seeds_of(const PackingCase& recipe) {
  std::vector<std::int64_t> seeds = recipe.seeds;
  for (int k = 0; recipe.seeds.empty() && k < recipe.candidates; ++k) seeds.push_back(recipe.seed + k);
  return seeds;
}

std::vector<PackedRve> obtain_packings(const SoilCase& soil, const PackingCase& recipe,
                                       std::span<const std::int64_t> seeds, const PackingNote& note, Bias bias) {
  if (recipe.file.extension() == ".h5") {
    auto rve = restored_packing(io::load_packing(recipe.file), soil);
    if (!rve)
      throw std::runtime_error(recipe.file.string() + " is not a complete packing of this program and its contact law");
    if (const std::string fault = interpenetration(*rve); !fault.empty() && note) {
      note("warning: the state in " + recipe.file.string() + ": " + fault);
    }
    if (note) note("packing read:  " + table_line(*rve));
    return {std::move(*rve)};
  }
  if (!recipe.file.empty()) {
    PackedRve rve = settle_foreign_packing(soil, recipe);
    if (rve.status != kernels::RveStatus::converged) {
      throw std::runtime_error(
          fmt::format("{} does not come to rest: {}", recipe.file.string(), kernels::name_of(rve.status)));
    }
    if (const std::string fault = interpenetration(rve); !fault.empty()) {
      throw std::runtime_error(recipe.file.string() + ": " + fault);
    }
    if (note)
      note("packing read:  " + table_line(rve) + "  (packing.grains, seeds and density of the recipe are not used)");
    return {rve};
  }
  std::vector<std::int64_t> missing;
  for (const std::int64_t seed : seeds) {
    if (!find(soil, recipe, seed)) missing.push_back(seed);
  }
  for (const PackedRve& rve : make_packings(soil, recipe, missing)) {
    if (rve.status != kernels::RveStatus::converged) {
      if (note)
        note(fmt::format("packing of seed {} does not come to rest ({}) and is left out", rve.seed,
                         kernels::name_of(rve.status)));
    } else if (!is_refused(rve, note)) {
      keep(soil, recipe, rve);
    }
  }
  std::vector<PackedRve> out;
  for (const std::int64_t seed : seeds) {
    auto rve = find(soil, recipe, seed);
    if (rve && !is_refused(*rve, note)) out.push_back(std::move(*rve));
  }
  if (out.empty()) throw std::runtime_error("no packing of this recipe comes to rest");
  if (bias == Bias::measured && out.size() > 1) measure_bias(soil, recipe, out);
  for (const PackedRve& rve : out) {
    const bool made = std::find(missing.begin(), missing.end(), rve.seed) != missing.end();
    if (note) note((made ? "packing made:  " : "packing found: ") + table_line(rve));
  }
  return out;
}

PackedRve choose_packing(const SoilCase& soil, const PackingCase& recipe, const PackingNote& note) {
  std::vector<PackedRve> all = obtain_packings(soil, recipe, seeds_of(recipe), note);
  if (all.size() == 1) return std::move(all.front());
  const auto less_biased = [](const PackedRve& a, const PackedRve& b) {
    return a.bias != b.bias ? a.bias < b.bias : a.seed < b.seed;
  };
  PackedRve best = *std::min_element(all.begin(), all.end(), less_biased);
  if (note) {
    note(fmt::format("packing of seed {} is used: its largest |tau_xy|/sigma_yy in oedometric compression is {:.4f}",
                     best.seed, best.bias));
  }
  return best;
}

}  // namespace voussoir::host
