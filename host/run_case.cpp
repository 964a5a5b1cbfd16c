#include "host/run_case.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "host/exit_code.hpp"
#include "host/packing.hpp"
#include "host/tunnel.hpp"

namespace voussoir::host {
namespace {

RunStatus run_column_case(const Case& input, const RunOptions& options) {
  std::filesystem::create_directories(options.folder);
  RunLog log(options.folder / "run.log", options.resume);
  return run_column(input, options, log).status;
}

int answer(RunStatus status, const RunOptions& options) {
  const std::string folder = options.folder.string();
  switch (status) {
    case RunStatus::finished: return exit_ok;
    case RunStatus::interrupted:
      std::fprintf(stderr, "stopped on request; `--resume` goes on from the last increment in %s\n", folder.c_str());
      return exit_interrupted;
    case RunStatus::failed:
      std::fprintf(stderr, "no equilibrium found, see %s/run.log; the last good checkpoint stays\n", folder.c_str());
      return exit_numerical;
  }
  return exit_machine;
}

/// Steps of one evaluation of one RVE, from the inertial number I = strain / steps * sqrt(m / (p t)) with the scaled mass
/// m of kernels/README.md (one stable step for all sizes), six neighbours, at pressure p.
double steps_per_evaluation(const Case& input, double strain, double pressure) {
  const SoilCase& soil = input.soil;
  const double k_n = soil.modulus * 0.25 * (soil.size_minimum + soil.size_maximum);
  const double mass = (6.0 + 12.0 * soil.stiffness_ratio) * k_n / (4.0 * 0.9 * 0.9);
  const double steps =
      strain / input.engine.inertial_number * std::sqrt(mass / (pressure * soil.thickness));
  const double hold = 0.25 * std::min(input.engine.hold_cap, 400);
  return std::clamp(steps, static_cast<double>(input.engine.minimum_steps),
                    static_cast<double>(input.engine.maximum_steps)) + hold;
}

}  // namespace

int run_case(const Case& input, const RunOptions& options) {
  switch (input.kind) {
    case CaseKind::tunnel: return answer(run_tunnel(input, options), options);
    case CaseKind::column: return answer(run_column_case(input, options), options);
    case CaseKind::pack: return run_pack(input, options);
    case CaseKind::probe: return run_probe(input, options);
  }
  return exit_machine;
}

CaseSize case_size(const Case& input) {
  CaseSize size;
  if (input.kind == CaseKind::pack || input.kind == CaseKind::probe) return size;
  const std::size_t gravity = gravity_targets(input).size();
  size.column_points = static_cast<std::size_t>(4 * input.column.elements);
  size.increments = gravity;
  size.points = size.column_points;
  std::size_t loss = 0;
  if (input.kind == CaseKind::tunnel) {
    size.points = static_cast<std::size_t>(tunnel_mesh(input.ground).n_points());
    loss = static_cast<std::size_t>(input.volume_loss.increments);
    size.increments += gravity + loss;
  }
  if (input.material != MaterialKind::grains) return size;
  // Measured on shrunk tunnels: about six evaluations an increment, strains of 1e-3 under gravity; in the volume loss the
  // ground strains on average by a tenth of the loss.
  constexpr double evaluations = 6;
  const double pressure = 0.5 * input.ground.unit_weight * input.ground.height;
  const double at_gravity = steps_per_evaluation(input, 1.0e-3, pressure) * static_cast<double>(gravity);
  const double loss_strain = loss > 0 ? 0.1 * input.volume_loss.total / static_cast<double>(loss) : 0.0;
  const double at_loss = steps_per_evaluation(input, loss_strain, pressure) * static_cast<double>(loss);
  const auto points = static_cast<double>(size.points);
  size.grains = points * input.packing.grains;
  const double column = input.kind == CaseKind::tunnel ? static_cast<double>(size.column_points) : 0.0;
  size.particle_steps = evaluations * input.packing.grains * (points * (at_gravity + at_loss) + column * at_gravity);
  return size;
}

}  // namespace voussoir::host
