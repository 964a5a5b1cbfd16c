#include "host/material/rve_pool.hpp"

#include <spdlog/fmt/fmt.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "host/case/accuracy.hpp"
#include "host/case/engine.hpp"
#include "host/case/result_fields.hpp"
#include "host/material/answers.hpp"
#include "host/material/deformation.hpp"
#include "kernels/describe_committed.hpp"
#include "kernels/device/device_residence.hpp"
#include "kernels/state/committed_contacts.hpp"
#include "kernels/state/mobility.hpp"

namespace voussoir::host {

namespace {

/// The number of steps is fixed at the first evaluation of an increment. An evaluation that needs more than this many
/// times the fixed number gets the larger number, because the predictor was far off.
constexpr int step_regret = 2;

kernels::EngineSettings settings_of(const PoolOptions& options) {
  kernels::EngineSettings settings = engine_settings(options.engine);
  settings.tangent = options.tangent;
  settings.tangent_tolerance = options.tangent_tolerance;
  settings.tangent_strain = options.tangent_strain;
  return settings;
}

/// The next number of the series 1.25^k. On this coarse grid the rounding of a predictor does not change the count.
int round_up(double steps) {
  return static_cast<int>(std::ceil(std::pow(1.25, std::ceil(std::log(steps) / std::log(1.25) - 1e-9))));
}

kernels::RveBatch batch_of_points(const PackingMix& mix) {
  std::vector<kernels::Packing> packings;
  for (const PackedRve& rve : mix.packings) packings.push_back(rve.packing);
  kernels::RveBatch batch = kernels::make_batch(std::move(packings), mix.of_point);
  for (std::size_t k = 0; k < mix.points(); ++k) {
    store_rve(mix.packings[static_cast<std::size_t>(mix.of_point[k])], batch, k);
  }
  return batch;
}

}  // namespace

RvePool::RvePool(const PackingMix& mix, const PoolOptions& options)
    : engine_(options.engine),
      settings_(settings_of(options)),
      microstructure_(options.microstructure),
      device_(choose_device(options.engine, options.tangent, options.local_rank)),
      batch_(batch_of_points(mix)),
      requests_(mix.points()),
      trial_reports_(mix.points()),
      committed_reports_(mix.points()),
      deferral_(engine_.defer, settings_.pressure_floor),
      retired_(mix.points()),
      numbers_(mix.numbers),
      least_areas_(least_areas(mix)),
      all_states_{batch_.committed, batch_.trial} {
  for (const kernels::Packing& packing : batch_.packings) {
    solid_areas_.push_back(packing.solid_area());
    mobilities_.push_back(
        kernels::mean_mobility<kernels::PlainEngineLaw>(packing, kernels::EngineSettings{}.overlap_limit));
  }
  if (device_.device) reside();
  if (!device_.device) start();
  for (std::size_t k = 0; k < mix.points(); ++k) {
    kernels::RveReport& report = committed_reports_[k];
    if (kernels::is_failure(report.status)) {
      const PackedRve& rve = mix.packings[static_cast<std::size_t>(mix.of_point[k])];
      throw std::invalid_argument(
          fmt::format("the packing of seed {} cannot start: {}", rve.seed, kernels::name_of(report.status)));
    }
    // No motion was asked for, so that the engine cannot tell rest from a hold that ended at once.
    if (report.status == kernels::RveStatus::step_limit && report.unbalanced <= settings_.hold_tolerance)
      report.status = kernels::RveStatus::converged;
  }
  deferral_.start(committed_reports_);
}

/// Answers for the RVEs at rest.
void RvePool::start() {
  kernels::advance(batch_, std::span<const kernels::StrainRequest>(requests_), settings_, committed_reports_);
}

/// Moves the RVEs to the device, which must then have the memory to advance them too. With `engine.backend` = "auto",
/// lanes advance them where it has not.
void RvePool::reside() {
  try {
    kernels::device::reside(batch_, device_.device, settings_.precision);
    start();
  } catch (const std::exception& fault) {
    if (engine_.backend == Backend::gpu) throw;
    batch_.residence.reset();
    device_ = {nullptr, fmt::format("the device {} is not used: {}", device_.device->name(), fault.what())};
  }
}

void RvePool::begin_increment() {
  steps_are_fixed_ = false;
  deferral_.begin_increment();
}

/// At the RVE's committed pressure [steps].
double RvePool::inertial_time_of(std::size_t rve) const {
  const double p = std::max(committed_reports_[rve].pressure(), settings_.pressure_floor);
  return kernels::inertial_time(mobilities_[static_cast<std::size_t>(batch_.packing_of[rve])],
                                batch_.packing(rve).thickness, p);
}

/// The number of steps with the target inertial number at the RVE's committed pressure. A pure rotation needs no steps,
/// since it does not strain the grains.
int RvePool::steps_for(std::size_t rve, const kernels::Mat2& f_rel) const {
  const double strain = kernels::symmetric_norm(kernels::log_of(f_rel));
  const double time = inertial_time_of(rve);
  const double steps = strain / inertial_number_at(time, engine_) * time;
  if (!std::isfinite(steps)) return engine_.minimum_steps;
  const double most = engine_.maximum_steps;
  return std::clamp(round_up(std::clamp(steps, 1.0, most)), engine_.minimum_steps, engine_.maximum_steps);
}

/// @param anew true: the number of steps before does not matter
void RvePool::choose_steps(std::size_t rve, const fem::Gradient& gradient, bool anew) {
  kernels::StrainRequest& request = requests_[rve];
  request.f_rel = deformation_of(gradient);
  const int steps = steps_for(rve, request.f_rel);
  if (anew || steps > step_regret * request.strain_steps) request.strain_steps = steps;
  request.hold_cap = engine_.hold_cap;
}

/// Chooses the RVEs whose grains run, and their requests: all RVEs but those that have been dug out and those that
/// their tangents answer for. Grains run with the whole gradient since their last run.
void RvePool::choose_running(std::span<const fem::Gradient> gradients) {
  running_.clear();
  increment_.assign(gradients.begin(), gradients.end());
  for (std::size_t k = 0; k < size(); ++k) {
    if (retired_.contains(k)) continue;
    const bool ran = steps_are_fixed_ && deferral_.runs(k);
    if (deferral_.on() && deferral_.answer(k, gradients[k], trial_reports_[k])) continue;
    choose_steps(k, deferral_.whole(k, gradients[k]), !ran);
    running_.push_back(static_cast<int>(k));
  }
  steps_are_fixed_ = true;
}

/// Without tangents the reports have the tangent of eq. (4), which is computed together with the stress.
kernels::Work RvePool::advance(std::span<const fem::Gradient> gradients, bool with_tangents) {
  kernels::EngineSettings settings = settings_;
  if (!with_tangents) settings.tangent = kernels::TangentKind::contact;
  choose_running(gradients);
  kernels::Work work;
  try {
    work = pieces_.advance(batch_, requests_, settings, trial_reports_, running_);
  } catch (...) {
    begin_increment();
    throw;
  }
  for (const int rve : running_) {
    const auto k = static_cast<std::size_t>(rve);
    deferral_.check(k, gradients[k], trial_reports_[k]);
  }
  return work;
}

fem::BatchReport RvePool::evaluate(std::span<const fem::Gradient> gradients, std::span<fem::Stress> stress,
                                   std::span<fem::Tangent> tangent) {
  const kernels::Work work = advance(gradients, !tangent.empty());
  copy_answers(trial_reports_, stress, tangent);
  retired_.clear(stress, tangent);
  fem::BatchReport report = summarise(trial_reports_, {settings_.pressure_floor, least_areas_, numbers_, retired_});
  report.work = work.particle_steps;
  report.lane_steps = work.lane_steps;
  report.tangent_time = work.tangent_time();
  report.deferral_error = deferral_.error();
  return report;
}

void RvePool::commit() {
  const kernels::RveStates before = batch_.committed;
  std::vector<int> kept;
  for (std::size_t k = 0; k < size(); ++k) {
    const bool is_retired = retired_.contains(k);
    if (is_retired) trial_reports_[k] = committed_reports_[k];
    const bool is_deferred = !is_retired && deferral_.on() && deferral_.commit(k, increment_[k], trial_reports_[k]);
    if (is_retired || is_deferred) kept.push_back(static_cast<int>(k));
  }
  kernels::commit(batch_, kept);
  committed_reports_ = trial_reports_;
  if (!is_held(before)) return;
  // The next states to be written are the trial states of lanes, or the committed ones that come from a device.
  (batch_.residence ? batch_.committed : batch_.trial) = free_states();
}

void RvePool::committed(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const {
  copy_answers(committed_reports_, stress, tangent);
  retired_.clear(stress, tangent);
}

std::vector<fem::PointField> RvePool::fields() const {
  std::vector<fem::PointField> out;
  const auto add = [&](const ResultField& row, auto&& value) {
    fem::PointField field{row.name, row.unit, row.components, std::vector<double>(size())};
    using Space = Kokkos::DefaultHostExecutionSpace;
    Kokkos::parallel_for("voussoir::fields", Kokkos::RangePolicy<Space>(0, size()),
                         [&](std::size_t k) { field.values[k] = value(k); });
    Space().fence("voussoir::fields");
    out.push_back(std::move(field));
  };
  const auto& reports = committed_reports_;
  std::vector<kernels::CommittedSummary> states(size());
  kernels::describe_committed(batch_, microstructure_, states);
  add(result_field("void_ratio"), [&](std::size_t k) { return void_ratio_at(k, states[k].cell_area); });
  add(result_field("grain_rotation"), [&](std::size_t k) { return states[k].network.grain_rotation; });
  add(result_field("coordination"),
      [&](std::size_t k) { return 2.0 * reports[k].contacts / batch_.packing(k).size(); });
  add(result_field("rve_status"), [&](std::size_t k) { return static_cast<double>(reports[k].status); });
  add(result_field("unbalanced_ratio"), [&](std::size_t k) { return reports[k].unbalanced; });
  add(result_field("inertial_number"), [&](std::size_t k) { return reports[k].inertial_number; });
  add(result_field("steps"), [&](std::size_t k) { return static_cast<double>(reports[k].steps); });
  if (batch_.packings.size() > 1) {
    add(result_field("packing"), [&](std::size_t k) { return static_cast<double>(batch_.packing_of[k]); });
  }
  if (engine_.accuracy > 0) {
    add(result_field("expected_error"),
        [&](std::size_t k) { return choose_inertial_number(engine_.accuracy, inertial_time_of(k)).error; });
  }
  for (const ResultField& row : result_field_table) {
    if (row.request == nullptr || !is_asked_for(row, microstructure_)) continue;
    add(row, [&](std::size_t k) { return row.of_network(states[k].network); });
  }
  retired_.clear(out);
  return out;
}

/// @param cell_area [m^2]
double RvePool::void_ratio_at(std::size_t rve, double cell_area) const {
  return void_ratio(cell_area, solid_areas_[static_cast<std::size_t>(batch_.packing_of[rve])]);
}

double RvePool::void_ratio_of(std::size_t rve) const {
  kernels::bring_committed(batch_, rve);
  const kernels::RveStates& s = batch_.committed;
  return void_ratio_at(rve, s.cell(rve, 0) * s.cell(rve, 3) - s.cell(rve, 1) * s.cell(rve, 2));
}

PackedRve RvePool::packed(std::size_t rve) const {
  kernels::bring_committed(batch_, rve);
  const kernels::RveReport& report = deferral_.on() ? deferral_.committed(rve).grains : committed_reports_[rve];
  PackedRve out;
  out.packing = batch_.packing(rve);
  load_rve(batch_.committed, rve, out);
  out.void_ratio = void_ratio_at(rve, out.cell.det());
  out.pressure = report.pressure();
  out.coordination = 2.0 * report.contacts / out.packing.size();
  out.unbalanced = report.unbalanced;
  out.mean_overlap = report.mean_overlap;
  return out;
}

io::RveSnapshot RvePool::snapshot(std::size_t rve) const {
  const kernels::Packing& packing = batch_.packing(rve);
  const PackedRve grains = packed(rve);
  io::RveSnapshot out;
  out.name = point_name(rve);
  out.cell = {grains.cell.xx, grains.cell.xy, grains.cell.yx, grains.cell.yy};
  out.thickness = packing.thickness;
  out.radius = packing.radii;
  out.rotation = grains.rotation;
  for (std::size_t i = 0; i < packing.radii.size(); ++i) {
    out.x.push_back(grains.position[2 * i]);
    out.y.push_back(grains.position[2 * i + 1]);
  }
  std::vector<kernels::CommittedContact> contacts;
  kernels::committed_contacts(batch_, rve, contacts);
  for (const kernels::CommittedContact& c : contacts) {
    out.contact_i.push_back(c.i);
    out.contact_j.push_back(c.j);
    out.branch.insert(out.branch.end(), {c.branch_x, c.branch_y});
    out.force.insert(out.force.end(), {c.force_x(), c.force_y()});
  }
  return out;
}

std::string point_name(std::size_t point) { return fmt::format("point_{:05d}", point); }

std::vector<io::RveSnapshot> RvePool::snapshots(std::span<const std::int64_t> points) const {
  std::vector<io::RveSnapshot> out;
  for (const std::int64_t point : points) {
    if (point < 0 || point >= static_cast<std::int64_t>(size()))
      throw std::out_of_range("there is no Gauss point of this number");
    out.push_back(snapshot(static_cast<std::size_t>(point)));
  }
  return out;
}

}  // namespace voussoir::host
