#include "tests/reference/reference_packing.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace voussoir::reference {
namespace {

/// Whether the next grain of a growing packing fits at `place` without touching those already placed (square cell).
bool is_free(const Rve& rve, Vec2 place) {
  const double side = rve.cell.xx;
  const double radius = rve.radii[rve.positions.size()];
  for (std::size_t k = 0; k < rve.positions.size(); ++k) {
    const Vec2 d = rve.positions[k] - place;
    const Vec2 nearest{d.x - side * std::round(d.x / side), d.y - side * std::round(d.y / side)};
    if (norm(nearest) < radius + rve.radii[k]) return false;
  }
  return true;
}

}  // namespace

Rve two_grains(double radius_i, double radius_j, double overlap, double angle, double cell_size,
               const Material& material) {
  const Vec2 centre{0.5 * cell_size, 0.5 * cell_size};
  const double distance = radius_i + radius_j - overlap;
  const Vec2 normal{std::cos(angle), std::sin(angle)};
  Rve rve;
  rve.positions = {centre - (0.5 * distance) * normal, centre + (0.5 * distance) * normal};
  rve.radii = {radius_i, radius_j};
  rve.cell = {cell_size, 0, 0, cell_size};
  rve.material = material;
  return rve;
}

Rve hexagonal_packing(int columns, int rows, double radius, double overlap, const Material& material) {
  if (rows % 2 != 0 || columns < 5 || rows < 6)
    throw std::invalid_argument("hexagonal_packing: at least 5 x 6, rows even");
  const double d = 2.0 * radius - overlap;
  const double height = 0.5 * std::sqrt(3.0) * d;
  Rve rve;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      rve.positions.push_back({(column + 0.5 * (row % 2)) * d, row * height});
    }
  }
  rve.radii.assign(rve.positions.size(), radius);
  rve.cell = {columns * d, 0, 0, rows * height};
  rve.material = material;
  return rve;
}

Rve loose_packing(int grain_count, double radius_min, double radius_max, std::uint64_t seed, const Material& material) {
  std::mt19937_64 random(seed);
  // Not std::uniform_real_distribution: its numbers depend on the library.
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
  Rve rve;
  rve.material = material;
  double area = 0;
  for (int k = 0; k < grain_count; ++k) {
    rve.radii.push_back(radius_min + (radius_max - radius_min) * uniform());
    area += std::numbers::pi * rve.radii.back() * rve.radii.back();
  }
  // Random sequential addition jams at an area fraction of 0.547; at 0.4 a place is found in some ten tries.
  const double side = std::sqrt(area / 0.4);
  rve.cell = {side, 0, 0, side};
  while (rve.positions.size() < rve.radii.size()) {
    const Vec2 place{side * uniform(), side * uniform()};
    if (is_free(rve, place)) rve.positions.push_back(place);
  }
  return rve;
}

void compress_to(Rve& rve, double target, double tolerance) {
  const StrainOptions coarse{.steps = 60, .hold_steps = 200, .tolerance = 1e-2};
  const StrainOptions fine{.steps = 100, .hold_steps = 4000, .tolerance = 1e-5};
  double strain_step = 0.01;
  double p = 0;
  for (int tries = 0; tries < 400; ++tries) {
    if (std::abs(p - target) <= tolerance * target) return;
    const VoigtMatrix d = tangent(rve);
    const double bulk = 0.25 * (d[0][0] + d[1][1] + 2.0 * d[0][1]);
    // Twice as soft as eq. (4) would be an overshoot's remedy; as stiff as it only takes a few more rounds.
    const double newton = bulk > 0 ? (target - p) / (2.0 * bulk) : strain_step;
    const bool near = p > 0.1 * target;
    const double e = near ? newton : strain_step;
    strain(rve, std::exp(-e) * identity, near ? fine : coarse);
    p = pressure(stress(rve));
    if (p > 10.0 * target && !near) {
      // Jammed within one coarse increment: go back out and approach in smaller ones.
      strain(rve, std::exp(strain_step) * identity, coarse);
      strain_step *= 0.5;
      p = pressure(stress(rve));
    }
  }
  throw std::runtime_error("compress_to: the pressure was not reached");
}

void switch_friction(Rve& rve, double friction, int hold_steps) {
  rve.material.friction = friction;
  strain(rve, identity, {.steps = 1, .hold_steps = hold_steps, .tolerance = 1e-6});
}

Rve consolidated_packing(int grain_count, std::uint64_t seed, double pressure, double consolidation_friction,
                         const Material& material) {
  Material slippery = material;
  slippery.friction = consolidation_friction;
  Rve rve = loose_packing(grain_count, 1.0e-3, 2.375e-3, seed, slippery);
  compress_to(rve, pressure);
  switch_friction(rve, material.friction);
  return rve;
}

}  // namespace voussoir::reference
