#include "host/packing/variety.hpp"

#include <numeric>
#include <utility>

#include "host/packing/grading.hpp"
#include "host/packing/law_range.hpp"

namespace voussoir::host {

PackingMix PackingMix::part(const std::vector<std::size_t>& points) const {
  PackingMix out{packings, {}};
  for (const std::size_t p : points) out.of_point.push_back(of_point[p]);
  return out;
}

std::vector<double> least_areas(const PackingMix& mix) {
  std::vector<double> of_packing, of_point;
  for (const PackedRve& rve : mix.packings)
    of_packing.push_back((1 + least_void_ratio(rve.packing)) * rve.packing.solid_area());
  for (const int packing : mix.of_point) of_point.push_back(of_packing[static_cast<std::size_t>(packing)]);
  return of_point;
}

PackingMix clones_of(PackedRve rve, std::size_t n) {
  PackingMix out;
  out.packings.push_back(std::move(rve));
  out.of_point.assign(n, 0);
  return out;
}

PackingMix mix(std::vector<PackedRve> packings, std::size_t n, std::int64_t seed) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  Uniform uniform(seed);
  for (std::size_t k = n; k > 1; --k) {  // Fisher and Yates
    std::swap(order[k - 1], order[static_cast<std::size_t>(uniform() * static_cast<double>(k))]);
  }
  PackingMix out{std::move(packings), std::vector<int>(n)};
  for (std::size_t k = 0; k < n; ++k) out.of_point[order[k]] = static_cast<int>(k % out.packings.size());
  return out;
}

}  // namespace voussoir::host
