#include "kernels/state/committed_network.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/contact/cell.hpp"
#include "kernels/contact/engine_law.hpp"

namespace voussoir::kernels {

namespace {

constexpr std::size_t block = 128;  // contacts whose numbers stay in the nearest cache between the loops below

/// Numbers of some contacts, each in an array of its own, so that the compiler makes vectors of them.
struct Block {
  double x[block], y[block];  ///< of the branch [m], then of the unit vector along it
  double reach[block];        ///< r_i + r_j [m]
  double length[block];       ///< of the branch [m]
  double overlap[block];      ///< overlap / length
  std::size_t size = 0;
};

/// std::nearbyint of a number below 2^51, which is a call of a function where the processor's baseline has no
/// instruction for it: the sum has no room for a fraction and is rounded to the nearest even number as all sums are.
inline double nearest_integer(double x) {
  constexpr double no_fraction = 0x1.8p52;
  return (x + no_fraction) - no_fraction;
}

/// Fills the branches, not yet those to the nearest images, and the distances at which the grains touch.
void gather(const RveStates& states, std::size_t rve, const Packing& packing, const std::uint32_t* keys, Block& b) {
  const double* const positions = &states.position(rve, 0, 0);
  const double* const radii = packing.radii.data();
  for (std::size_t c = 0; c < b.size; ++c) {
    const auto i = static_cast<std::size_t>(first_of(keys[c])), j = static_cast<std::size_t>(second_of(keys[c]));
    b.x[c] = positions[2 * j] - positions[2 * i];
    b.y[c] = positions[2 * j + 1] - positions[2 * i + 1];
    b.reach[c] = radii[i] + radii[j];
  }
}

/// The operations are those of Cell::nearest and of committed_contacts, in their order.
void measure(const Cell& cell, Block& b) {
  const Mat2 h = cell.h, inverse = cell.inverse;
  for (std::size_t c = 0; c < b.size; ++c) {
    const double dx = b.x[c], dy = b.y[c];
    const double first = nearest_integer(inverse.xx * dx + inverse.xy * dy);
    const double second = nearest_integer(inverse.yx * dx + inverse.yy * dy);
    const double x = dx - (h.xx * first + h.xy * second);
    const double y = dy - (h.yx * first + h.yy * second);
    const double length = std::sqrt(x * x + y * y);
    b.x[c] = x / length;
    b.y[c] = y / length;
    b.length[c] = length;
    b.overlap[c] = (b.reach[c] - length) / length;
  }
}

/// Of one call of the law without motion. The law's normal force has no memory (contact/contact_law.hpp), so that no
/// history is read, and what the law computes of other forces is left out by the compiler.
double normal_force(const Packing& packing, std::size_t i, std::size_t j, const Block& b, std::size_t c) {
  using Law = EngineLaw<SingleLane<double>, false>;
  using V = Law::Value;
  const Law law(Law::combine(packing.material_of(i), packing.radii[i], packing.material_of(j), packing.radii[j]));
  Law::History history = no_history<Law>();
  const double overlap = b.reach[c] - b.length[c];
  const auto force = law({V(overlap / b.reach[c]), V(b.overlap[c]), V(0.0), V(0.0)}, history);
  return force.normal_to_branch[0] * b.length[c];
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
    for (std::size_t c = 0; c < b.size; ++c) {
      const int i = first_of(keys[c]), j = second_of(keys[c]);
      out[first + c] = {i, j, b.x[c], b.y[c],
                        normal_force(packing, static_cast<std::size_t>(i), static_cast<std::size_t>(j), b, c)};
    }
  }
}

}  // namespace voussoir::kernels
