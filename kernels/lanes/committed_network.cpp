#include "kernels/lanes/committed_network.hpp"

#include <algorithm>

#include "kernels/contact/committed_pair.hpp"
#include "kernels/contact/engine_law.hpp"
#include "kernels/lanes/wide_lane.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

namespace {

/// Several contacts of one RVE are measured at once, one a lane.
using Lanes = WideLane<double>;
constexpr std::size_t at_once = static_cast<std::size_t>(lane_count<Lanes>);

constexpr std::size_t block = 128;  // contacts whose numbers stay in the nearest cache from one function to the next
static_assert(block % at_once == 0);

/// Numbers of some contacts. Lanes beyond the last contact compute with whatever stands there.
struct Block {
  std::size_t size = 0;
  double x[block]{}, y[block]{};                      ///< of the branch [m], then of the unit vector along it
  double radius_of_i[block]{}, radius_of_j[block]{};  ///< [m]
  double length[block]{};                             ///< of the branch [m]
  double overlap[block]{};                            ///< [m]
  double overlap_to_branch[block]{};                  ///< overlap / length
};

Lanes load(const double* from) {
  Lanes v;
  v.copy_from(from, Kokkos::Experimental::element_aligned_tag());
  return v;
}

void store(const Lanes& v, double* to) { v.copy_to(to, Kokkos::Experimental::element_aligned_tag()); }

/// Fills the radii, and the branches without the choice of an image.
void gather(const RveStates& states, std::size_t rve, const Packing& packing, const std::uint32_t* keys, Block& b) {
  const double* const positions = &states.position(rve, 0, 0);
  const double* const radii = packing.radii.data();
  for (std::size_t c = 0; c < b.size; ++c) {
    const auto i = static_cast<std::size_t>(first_of(keys[c])), j = static_cast<std::size_t>(second_of(keys[c]));
    b.x[c] = positions[2 * j] - positions[2 * i];
    b.y[c] = positions[2 * j + 1] - positions[2 * i + 1];
    b.radius_of_i[c] = radii[i];
    b.radius_of_j[c] = radii[j];
  }
}

void measure(const Cell& cell, Block& b) {
  for (std::size_t c = 0; c < b.size; c += at_once) {
    const CentreLine<Lanes> line = centre_line(cell, load(b.x + c), load(b.y + c), load(b.radius_of_i + c),
                                               load(b.radius_of_j + c));
    store(line.normal_x, b.x + c);
    store(line.normal_y, b.y + c);
    store(line.length, b.length + c);
    store(line.overlap, b.overlap + c);
    store(line.overlap_to_branch, b.overlap_to_branch + c);
  }
}

double normal_force(const GrainMaterial& of_i, const GrainMaterial& of_j, const Block& b, std::size_t c) {
  return normal_force_at_rest<NormalForceLaw>(of_i, b.radius_of_i[c], of_j, b.radius_of_j[c], b.overlap[c],
                                              b.overlap_to_branch[c], b.length[c]);
}

void give(const Packing& packing, const std::uint32_t* keys, const Block& b, NetworkContact* out) {
  for (std::size_t c = 0; c < b.size; ++c) {
    const int i = first_of(keys[c]), j = second_of(keys[c]);
    out[c] = {i, j, b.x[c], b.y[c],
              normal_force(packing.material_of(static_cast<std::size_t>(i)),
                           packing.material_of(static_cast<std::size_t>(j)), b, c)};
  }
}

}  // namespace

void committed_network(const RveBatch& batch, std::size_t rve, std::vector<NetworkContact>& out) {
  const RveStates& s = batch.committed;
  const Packing& packing = batch.packing(rve);
  const Cell cell(Mat2{s.cell(rve, 0), s.cell(rve, 1), s.cell(rve, 2), s.cell(rve, 3)});
  const auto count = static_cast<std::size_t>(s.contact_count(rve));
  out.resize(count);
  Block b;
  for (std::size_t first = 0; first < count; first += block) {
    const std::uint32_t* const keys = &s.contact_key(rve, first);
    b.size = std::min(block, count - first);
    gather(s, rve, packing, keys, b);
    measure(cell, b);
    give(packing, keys, b, out.data() + first);
  }
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
