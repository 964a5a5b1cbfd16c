#include "host/stages/make_material.hpp"

#include <utility>

#include "fem/linear_elastic.hpp"
#include "host/case/result_fields.hpp"
#include "host/material/mirrored_batch.hpp"
#include "host/material/rve_pool.hpp"
#include "host/ranks/session.hpp"

namespace voussoir::host {
namespace {

/// A pool with the chosen packings at the points.
std::unique_ptr<fem::MaterialBatch> make_rve_pool(const MaterialCase& material, std::size_t n_points,
                                                  const PackingNote& note) {
  PackingMix mix = choose_packings(material.soil, material.packing, n_points, note);
  PoolOptions options = options_for_newton(material.engine, material.tangent, material.tangent_strain);
  options.microstructure = material.microstructure;
  options.local_rank = local_rank();
  if (rank_count() > 1) return make_rank_pool(std::move(mix), options, note);
  auto pool = std::make_unique<RvePool>(mix, options);
  if (note && !pool->device_sentence().empty()) note(pool->device_sentence());
  return pool;
}

}  // namespace

MaterialCase material_case(const Case& input) {
  return {.kind = input.material,
          .soil = input.soil,
          .packing = input.packing,
          .engine = input.engine,
          .elastic = input.elastic,
          .tangent = input.newton.tangent,
          .tangent_strain = input.newton.tangent_strain,
          .microstructure = written_quantities(input.output)};
}

std::unique_ptr<fem::MaterialBatch> make_material(const MaterialCase& material, std::size_t n_points,
                                                  const PackingNote& note) {
  if (material.kind == MaterialKind::grains) {
    auto pool = make_rve_pool(material, n_points, note);
    if (!material.packing.mirrored) return pool;
    return std::make_unique<MirroredBatch>(std::move(pool));
  }
  const double pressure = material.packing.pressure;
  return std::make_unique<fem::LinearElastic>(
      n_points, fem::ElasticOptions{.young = material.elastic.modulus,
                                    .poisson = material.elastic.poisson,
                                    .initial_stress = fem::Stress(-pressure, -pressure, 0.0),
                                    .strain = fem::ElasticStrain::logarithmic});
}

}  // namespace voussoir::host
