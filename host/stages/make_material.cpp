#include "host/stages/make_material.hpp"

#include <utility>

#include "fem/linear_elastic.hpp"
#include "host/material/mirrored_batch.hpp"
#include "host/material/rve_pool.hpp"

namespace voussoir::host {

std::unique_ptr<fem::MaterialBatch> make_material(const Case& input, std::size_t n_points, const PackingNote& note) {
  if (input.material == MaterialKind::grains) {
    auto pool = make_rve_pool(input, n_points, note);
    if (!input.packing.mirrored) return pool;
    return std::make_unique<MirroredBatch>(std::move(pool));
  }
  const double pressure = input.packing.pressure;
  return std::make_unique<fem::LinearElastic>(
      n_points, fem::ElasticOptions{.young = input.elastic.modulus,
                                    .poisson = input.elastic.poisson,
                                    .initial_stress = fem::Stress(-pressure, -pressure, 0.0),
                                    .strain = fem::ElasticStrain::logarithmic});
}

}  // namespace voussoir::host
