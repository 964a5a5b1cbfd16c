#include "host/material_factory.hpp"

#include "fem/linear_elastic.hpp"
#if __has_include("host/rve_pool.hpp")
#include "host/rve_pool.hpp"
#else
#include "io/case_file.hpp"
#endif

namespace voussoir::host {

std::unique_ptr<fem::MaterialBatch> make_material(const Case& input, std::size_t n_points) {
  const double pressure = input.packing.pressure;
  if (input.material == MaterialKind::linear_elastic) {
    return std::make_unique<fem::LinearElastic>(
        n_points, fem::ElasticOptions{.young = input.elastic.modulus,
                                      .poisson = input.elastic.poisson,
                                      .initial_stress = fem::Stress(-pressure, -pressure, 0.0),
                                      .strain = fem::ElasticStrain::logarithmic});
  }
#if __has_include("host/rve_pool.hpp")
  return make_rve_pool(input, n_points);
#else
  throw io::InputError("case", "material", "grains are not built in yet");
#endif
}

}  // namespace voussoir::host
