#include "host/case_size.hpp"

#include <algorithm>
#include <cmath>

#include "host/stages.hpp"
#include "host/tunnel.hpp"

namespace voussoir::host {
namespace {

// Calibrated on the column `particle_steps` of run.h5 (evaluations an increment, steps an evaluation):
//   cases/tunnel_quick, I = 3e-4      column 1.7, 132; gravity 1.8, 131; volume loss 4.9, 146
//   the same, coarser, 1e-4, V_l 5 %  column 1.7, 218; gravity 1.9, 206; volume loss 3.0, 160
//   cases/column, I = 2e-4            column 1.7, 144
// With the constants below these runs are estimated at 1.1, 1.4 and 0.95 of what they took, and tunnel_quick with two other
// packings (packing.seed = 20, 40), which were harder to bring to equilibrium, at 0.76 and 0.67.
constexpr double gravity_evaluations = 1.8;
constexpr double loss_evaluations = 6.0;
constexpr double gravity_strain = 0.014;  ///< mean strain of an RVE over the load factor's step
constexpr double loss_strain = 0.2;       ///< mean strain of an RVE over the volume loss of an increment
constexpr double hold_steps = 30;
constexpr double specimen_evaluations = 6.0;
constexpr double specimen_strain = 1.4;  ///< norm of an RVE's strain over the top's, without change of volume

/// Steps of one evaluation of one RVE, from the inertial number I = strain / steps * sqrt(m / (p t)) with the scaled mass
/// m of kernels/README.md (one stable step for all sizes), six neighbours.
double steps_per_evaluation(const Case& input, double strain, double pressure) {
  const SoilCase& soil = input.soil;
  const double k_n = soil.modulus * 0.25 * (soil.size_minimum + soil.size_maximum);
  const double mass = (6.0 + 12.0 * soil.stiffness_ratio) * k_n / (4.0 * 0.9 * 0.9);
  const double steps = strain / input.engine.inertial_number * std::sqrt(mass / (pressure * soil.thickness));
  return std::clamp(steps, static_cast<double>(input.engine.minimum_steps),
                    static_cast<double>(input.engine.maximum_steps)) +
         std::min(hold_steps, static_cast<double>(input.engine.hold_cap));
}

CaseSize specimen_size(const Case& input) {
  const BiaxialBvpCase& test = input.biaxial_bvp;
  CaseSize size;
  size.points = static_cast<std::size_t>(4 * test.columns * test.rows);
  size.increments = static_cast<std::size_t>(test.increments());
  if (input.material != MaterialKind::grains) return size;
  size.grains = static_cast<double>(size.points) * input.packing.grains;
  size.particle_steps = size.grains * specimen_evaluations * test.increments() *
                        steps_per_evaluation(input, specimen_strain * test.strain_step, 2 * test.pressure);
  return size;
}

}  // namespace

CaseSize case_size(const Case& input) {
  CaseSize size;
  if (input.kind == CaseKind::biaxial_bvp) return specimen_size(input);
  if (input.kind != CaseKind::column && input.kind != CaseKind::tunnel) return size;
  const bool with_tunnel = input.kind == CaseKind::tunnel;
  const std::size_t gravity = gravity_targets(input).size();
  const auto loss = with_tunnel ? static_cast<std::size_t>(input.volume_loss.increments) : std::size_t{0};
  size.column_points = static_cast<std::size_t>(4 * input.column.elements);
  size.points = with_tunnel ? static_cast<std::size_t>(tunnel_mesh(input.ground).n_points()) : size.column_points;
  size.increments = with_tunnel ? 2 * gravity + loss : gravity;
  if (input.material != MaterialKind::grains) return size;

  const auto points = static_cast<double>(size.points);
  const double pressure = 0.5 * input.ground.unit_weight * input.ground.height;  // at half the depth
  const double under_gravity = gravity_evaluations * static_cast<double>(gravity) *
                               steps_per_evaluation(input, gravity_strain * input.gravity.uniform_step, pressure);
  size.grains = points * input.packing.grains;
  size.particle_steps = size.grains * under_gravity;
  if (with_tunnel) {
    const double step = input.volume_loss.total / static_cast<double>(loss);
    size.particle_steps += static_cast<double>(size.column_points) * input.packing.grains * under_gravity;
    size.particle_steps += size.grains * loss_evaluations * static_cast<double>(loss) *
                           steps_per_evaluation(input, loss_strain * step, pressure);
  }
  return size;
}

}  // namespace voussoir::host
