#include "host/program/accept_case.hpp"

#include <spdlog/fmt/fmt.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "host/case/engine.hpp"
#include "host/case/load_case.hpp"
#include "host/estimate/range.hpp"
#include "host/estimate/report.hpp"
#include "host/estimate/scene.hpp"
#include "host/estimate/storage.hpp"
#include "host/estimate/work.hpp"
#include "host/material/devices.hpp"
#include "host/packing/case_recipes.hpp"
#include "host/packing/packing_check.hpp"
#include "host/process/resources.hpp"
#include "host/ranks/session.hpp"
#include "io/input_error.hpp"
#include "kernels/isa/choose_lanes.hpp"

namespace voussoir::host {
namespace {

/// The skin of the neighbour lists with which this case runs; 0 where [engine] decides nothing.
double skin_of(const Case& input) { return uses_engine(input.kind, input.material) ? input.engine.skin : 0.0; }

/// A rehearsal on the elastic material checks files too.
void check_files(const Case& input, const SoilRecipe& recipe) {
  try {
    check_packing_files(*recipe.soil, *recipe.packing, skin_of(input));
  } catch (const std::runtime_error& fault) {
    const std::string key = recipe.table + "packing.file";
    throw io::InputError(place_of(input, key), key, fault.what());
  }
}

void check_packings(const Case& input) {
  const std::vector<SoilRecipe> recipes = recipes_of(input);
  if (recipes.empty()) return check_files(input, {&input.soil, &input.packing, ""});
  for (const SoilRecipe& recipe : recipes) {
    check_files(input, recipe);
    std::string key = recipe.table + "packing.grains";
    try {
      if (recipe.packing->files.empty()) check_recipe(*recipe.soil, recipe.packing->grains, skin_of(input));
      if (input.kind != CaseKind::calibrate) continue;
      key = "calibrate.confirm_grains";
      check_recipe(input.soil, input.calibrate.confirm_grains, 0.0);
    } catch (const std::runtime_error& fault) {
      throw io::InputError(place_of(input, key), key, fault.what());
    }
  }
}

/// Refuses more packings than a region, or the mesh, has points.
void refuse_idle_packings(const Case& input, const SoilRecipe& recipe, const std::string& place, std::size_t points) {
  const auto variety = static_cast<std::size_t>(recipe.packing->variety);
  if (variety <= points) return;
  const std::string key = recipe.table + "packing.variety";
  throw io::InputError(
      place_of(input, key), key,
      fmt::format("asks for {} packings, but the {} has only {} points to hold them", variety, place, points));
}

/// Refuses more packings than there are points to hold them.
void refuse_idle_packings(const Case& input, const CaseSize& size) {
  if (size.points == 0) return;
  for (const SoilRecipe& recipe : recipes_of(input)) {
    if (recipe.regions.empty()) refuse_idle_packings(input, recipe, "mesh", size.points);
    for (const RegionSize& region : size.regions) {
      if (std::find(recipe.regions.begin(), recipe.regions.end(), region.name) != recipe.regions.end())
        refuse_idle_packings(input, recipe, "region " + region.name, region.points);
    }
  }
}

/// The size of the case. What the mesh generator refuses is a fault of the ground's lengths, or of the file that holds
/// the mesh.
CaseSize checked_size(const Case& input) {
  const char* key = input.ground.mesh_file.empty() ? "ground" : "ground.mesh_file";
  try {
    return case_size(input);
  } catch (const io::InputError&) {
    throw;
  } catch (const std::invalid_argument& fault) {
    throw io::InputError(place_of(input, key), key, fault.what());
  } catch (const std::runtime_error& fault) {
    throw io::InputError(place_of(input, key), key, fault.what());
  }
}

/// Refuses a case that asks for a GPU where there is none: the machine of this command decides, as for `engine.isa`.
void refuse_missing_device(const Case& input) {
  if (input.engine.backend != Backend::gpu) return;
  try {
    static_cast<void>(choose_device(input, local_rank()));
  } catch (const std::runtime_error& fault) {
    throw io::InputError(place_of(input, "engine.backend"), "engine.backend", fault.what());
  }
}

/// Remarks about grains that packings lack, and about lanes without an RVE.
void add_remarks(AcceptedCase& accepted) {
  std::vector<std::string>& remarks = accepted.input.remarks;
  for (const SoilRecipe& recipe : recipes_of(accepted.input)) {
    if (!recipe.packing->files.empty()) continue;
    const std::string missing = missing_coarse_grains(*recipe.soil, recipe.packing->grains);
    if (!missing.empty()) remarks.push_back(recipe.regions.empty() ? missing : recipe.place() + ": " + missing);
  }
  if (const std::string lanes = lanes_warning(accepted.size); !lanes.empty()) remarks.push_back(lanes);
}

}  // namespace

void refuse_endless_mesh(const Case& input) {
  if (input.kind != CaseKind::tunnel || !input.ground.mesh_file.empty()) return;
  const GroundCase& ground = input.ground;
  const double squares = ground.width * ground.height / (ground.mesh_size_far * ground.mesh_size_far);
  const double needed = mesh_memory(4 * 0.5 * squares), there = memory_limit();
  if (needed <= there) return;
  throw io::InputError(
      place_of(input, "ground.mesh_size_far"), "ground.mesh_size_far",
      fmt::format("{:.4g} m on a ground of {:.4g} m x {:.4g} m make a mesh of over {:.2g} Gauss points "
                  "and {} of memory, but this machine allows {}",
                  ground.mesh_size_far, ground.width, ground.height, 2 * squares, bytes_text(needed),
                  bytes_text(there)));
}

AcceptedCase accept_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  AcceptedCase accepted{load_case(file, overrides), {}};
  check_packings(accepted.input);
  refuse_endless_mesh(accepted.input);
  accepted.size = checked_size(accepted.input);
  refuse_idle_packings(accepted.input, accepted.size);
  check_snapshot_points(accepted.input.output, accepted.size, place_of(accepted.input, "output.rves"));
  const kernels::LaneSet& lanes = *kernels::choose_lanes(accepted.input.engine.isa).lanes;
  accepted.size.lanes_share = share_of_lanes(accepted.size.regions, lanes.width(accepted.input.engine.precision));
  refuse_missing_device(accepted.input);
  add_remarks(accepted);
  Foretold foretold = foretell(accepted.input, accepted.size.height);
  for (std::string& warning : foretold.warnings) accepted.input.remarks.push_back(std::move(warning));
  accepted.range = std::move(foretold.line);
  return accepted;
}

void refuse_too_large(const Case& input, const CaseSize& size, int ranks) {
  const double needed = size.memory / ranks, there = memory_limit();
  if (needed <= there) return;
  const char* mesh_key = input.kind == CaseKind::biaxial_bvp ? "biaxial_bvp.columns"
                         : input.kind == CaseKind::scene     ? "mesh"
                                                             : "ground";
  const char* key = has_grains(input) ? "packing.grains" : mesh_key;
  throw io::InputError(
      input.name, key,
      fmt::format("the run takes about {} of memory, but this machine allows {}: it needs fewer points, "
                  "grains, packings or tests",
                  bytes_text(needed), bytes_text(there)));
}

}  // namespace voussoir::host
