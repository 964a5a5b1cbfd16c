#include "host/packing/variety.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "host/packing/grading.hpp"
#include "host/packing/law_range.hpp"

namespace voussoir::host {

PackingMix PackingMix::part(const std::vector<std::size_t>& points) const {
  PackingMix out{packings, {}};
  for (const std::size_t p : points) {
    out.of_point.push_back(of_point[p]);
    if (!numbers.empty()) out.numbers.push_back(numbers[p]);
  }
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

namespace {

bool is_same_material(const kernels::GrainMaterial& a, const kernels::GrainMaterial& b) {
  return std::all_of(kernels::material_numbers.begin(), kernels::material_numbers.end(),
                     [&](const kernels::MaterialNumber& n) { return a.*n.number == b.*n.number; });
}

/// True where no RVE could tell the two apart.
bool is_same_packing(const PackedRve& a, const PackedRve& b) {
  const kernels::Packing &p = a.packing, &q = b.packing;
  const auto state = [](const PackedRve& r) {
    return std::tie(r.position, r.rotation, r.cell.xx, r.cell.xy, r.cell.yx, r.cell.yy, r.contact_key,
                    r.contact_history);
  };
  return std::tie(p.radii, p.class_of, p.thickness, p.local_damping) ==
             std::tie(q.radii, q.class_of, q.thickness, q.local_damping) &&
         std::equal(p.materials.begin(), p.materials.end(), q.materials.begin(), q.materials.end(), is_same_material) &&
         state(a) == state(b);
}

}  // namespace

PackingMix join(std::vector<PackingMix> mixes, const std::vector<std::vector<std::size_t>>& places) {
  PackingMix out;
  std::size_t n = 0;
  for (const PackingMix& mix : mixes) n += mix.points();
  out.of_point.resize(n);
  for (std::size_t k = 0; k < mixes.size(); ++k) {
    std::vector<int> index;  // of each packing of this mix, among all
    for (PackedRve& rve : mixes[k].packings) {
      auto found = std::find_if(out.packings.begin(), out.packings.end(),
                                [&](const PackedRve& other) { return is_same_packing(rve, other); });
      if (found == out.packings.end()) found = out.packings.insert(found, std::move(rve));
      index.push_back(static_cast<int>(found - out.packings.begin()));
    }
    for (std::size_t i = 0; i < mixes[k].points(); ++i)
      out.of_point[places[k][i]] = index[static_cast<std::size_t>(mixes[k].of_point[i])];
  }
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
