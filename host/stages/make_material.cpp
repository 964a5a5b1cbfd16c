#include "host/stages/make_material.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "fem/linear_elastic.hpp"
#include "host/case/result_fields.hpp"
#include "host/material/mirrored_batch.hpp"
#include "host/material/region_batch.hpp"
#include "host/material/rve_pool.hpp"
#include "host/ranks/session.hpp"

namespace voussoir::host {
namespace {

using Points = std::vector<std::size_t>;

/// A region with its points of the mesh, ascending.
struct RegionPoints {
  const RegionCase* region = nullptr;
  std::string name;
  Points points;
};

/// The regions of the mesh that have points, in the order of the case.
std::vector<RegionPoints> regions_of(const std::vector<RegionCase>& cases, const fem::Mesh& mesh) {
  std::vector<RegionPoints> all;
  for (const RegionCase& region : cases) {
    for (const std::string& name : region.names) all.push_back({&region, name, {}});
  }
  for (int e = 0; e < mesh.n_elements(); ++e) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const RegionPoints& r) { return mesh.in_region(e, r.name); });
    if (found == all.end())
      throw std::invalid_argument("region '" + mesh.region_names[mesh.region[e]] + "' of the mesh has no [[region]]");
    for (int p = 4 * e; p < 4 * e + 4; ++p) found->points.push_back(static_cast<std::size_t>(p));
  }
  std::erase_if(all, [](const RegionPoints& r) { return r.points.empty(); });
  return all;
}

/// A pool with these packings at its points.
std::unique_ptr<fem::MaterialBatch> pool_of(const MaterialCase& material, PackingMix mix, const PackingNote& note) {
  PoolOptions options = options_for_newton(material.engine, material.tangent, material.tangent_strain);
  options.microstructure = material.microstructure;
  options.local_rank = local_rank();
  const auto make = [&]() -> std::unique_ptr<fem::MaterialBatch> {
    if (rank_count() > 1) return make_rank_pool(std::move(mix), options, note);
    auto pool = std::make_unique<RvePool>(mix, options);
    if (note && !pool->device_sentence().empty()) note(pool->device_sentence());
    return pool;
  };
  if (!material.packing.mirrored) return make();
  return std::make_unique<MirroredBatch>(make());
}

std::unique_ptr<fem::MaterialBatch> elastic_batch(const ElasticCase& elastic, double pressure, std::size_t n) {
  return std::make_unique<fem::LinearElastic>(
      n, fem::ElasticOptions{.young = elastic.modulus,
                             .poisson = elastic.poisson,
                             .initial_stress = fem::Stress(-pressure, -pressure, 0.0),
                             .strain = fem::ElasticStrain::logarithmic});
}

/// One pool for the regions with grains, so that no thread idles at the end of each region's own pool.
RegionPart grains_part(const MaterialCase& material, const std::vector<RegionPoints>& regions, bool is_whole_mesh,
                       const PackingNote& note) {
  Points points;
  for (const RegionPoints& r : regions) points.insert(points.end(), r.points.begin(), r.points.end());
  std::sort(points.begin(), points.end());
  std::vector<PackingMix> mixes;
  std::vector<Points> places;
  for (const RegionPoints& r : regions) {
    PackingCase recipe = r.region->packing;
    recipe.pressure = material.packing.pressure;
    const PackingNote prefixed = [&](const std::string& text) { note("region " + r.name + ": " + text); };
    const bool is_only = regions.size() == 1;
    mixes.push_back(choose_packings(r.region->soil, recipe, r.points.size(), note && !is_only ? prefixed : note));
    Points& of_mix = places.emplace_back();
    for (const std::size_t p : r.points) {
      of_mix.push_back(static_cast<std::size_t>(std::lower_bound(points.begin(), points.end(), p) - points.begin()));
    }
  }
  PackingMix mix = mixes.size() == 1 ? std::move(mixes.front()) : join(std::move(mixes), places);
  if (!is_whole_mesh) mix.numbers = points;
  return {pool_of(material, std::move(mix), note), std::move(points)};
}  // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks): the part owns its batch, which the check loses.

std::unique_ptr<fem::MaterialBatch> material_of_regions(const MaterialCase& material, const fem::Mesh& mesh,
                                                        const PackingNote& note) {
  std::vector<RegionPoints> grains;
  std::map<std::pair<double, double>, Points> elastic;  // by Young's modulus and Poisson's ratio
  for (RegionPoints& r : regions_of(material.regions, mesh)) {
    const ElasticCase constants = r.region->elastic.value_or(material.elastic);
    if (material.kind == MaterialKind::grains && !r.region->elastic) {
      grains.push_back(std::move(r));
    } else {
      Points& points = elastic[{constants.modulus, constants.poisson}];
      points.insert(points.end(), r.points.begin(), r.points.end());
    }
  }
  std::vector<RegionPart> parts;
  if (!grains.empty()) parts.push_back(grains_part(material, grains, elastic.empty(), note));
  for (auto& [constants, points] : elastic) {
    std::sort(points.begin(), points.end());
    const ElasticCase of_part{.modulus = constants.first, .poisson = constants.second};
    parts.push_back({elastic_batch(of_part, material.packing.pressure, points.size()), points});
  }
  if (parts.size() == 1) return std::move(parts.front().batch);
  return std::make_unique<RegionBatch>(std::move(parts));
}  // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks): as above.

}  // namespace

MaterialCase material_case(const Case& input) {
  return {.kind = input.material,
          .soil = input.soil,
          .packing = input.packing,
          .engine = input.engine,
          .elastic = input.elastic,
          .tangent = input.newton.tangent,
          .tangent_strain = input.newton.tangent_strain,
          .microstructure = written_quantities(input.output),
          .regions = input.kind == CaseKind::scene ? input.scene.regions : std::vector<RegionCase>()};
}

std::unique_ptr<fem::MaterialBatch> make_material(const MaterialCase& material, const fem::Mesh& mesh,
                                                  const PackingNote& note) {
  if (!material.regions.empty()) return material_of_regions(material, mesh, note);
  const auto n = static_cast<std::size_t>(mesh.n_points());
  if (material.kind == MaterialKind::linear_elastic)
    return elastic_batch(material.elastic, material.packing.pressure, n);
  return pool_of(material, choose_packings(material.soil, material.packing, n, note), note);
}

}  // namespace voussoir::host
