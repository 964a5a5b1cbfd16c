#pragma once
/// One RVE at each Gauss point, as a fem::MaterialBatch: the pool chooses step counts, runs the engine and answers with
/// stress and tangent.

#include "fem/material_batch.hpp"
#include "fem/retired_points.hpp"
#include "host/case/case.hpp"
#include "host/material/deferral.hpp"
#include "host/material/devices.hpp"
#include "host/material/held_rves.hpp"
#include "host/material/piecewise.hpp"
#include "host/material/snapshot_source.hpp"
#include "host/material/state_records.hpp"
#include "host/packing/variety.hpp"
#include "kernels/advance_rves.hpp"

namespace voussoir::host {

/// Settings of a pool; the constructor takes the packing and the size.
struct PoolOptions {
  EngineCase engine;
  kernels::TangentKind tangent = kernels::TangentKind::contact;
  double tangent_tolerance = kernels::EngineSettings{}.tangent_tolerance;  ///< tolerance of a static tangent [-]
  double tangent_strain = 1.0e-6;                                          ///< strain of a loading tangent [-]
  kernels::MicrostructureRequest microstructure = {};  ///< fields to add to fields(), which computes them at each call
  int local_rank = 0;  ///< number of this process among those of its machine, which share its devices in turn
};

/// The options of a pool with whose tangents Newton iterates. They may be off by 1 %, as their error is estimated.
[[nodiscard]] PoolOptions options_for_newton(const EngineCase& engine, TangentChoice tangent, double tangent_strain);

class RvePool final : public fem::MaterialBatch, public SnapshotSource {
 public:
  /// One RVE at each point, with the state of the packing that the mix names for it.
  RvePool(const PackingMix& mix, const PoolOptions& options);
  /// Makes `n` clones of `rve`.
  RvePool(const PackedRve& rve, const PoolOptions& options, std::size_t n) : RvePool(clones_of(rve, n), options) {}

  [[nodiscard]] std::size_t size() const override { return batch_.size(); }
  void begin_increment() override;
  fem::BatchReport evaluate(std::span<const fem::Gradient> gradients, std::span<fem::Stress> stress,
                            std::span<fem::Tangent> tangent) override;
  void commit() override;
  void committed(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const override;
  [[nodiscard]] std::vector<fem::PointField> fields() const override;
  [[nodiscard]] std::vector<std::byte> state() const override;
  void set_state(std::span<const std::byte> bytes) override;
  /// The grains of these points stay as they are, in checkpoints too.
  void retire(std::span<const std::size_t> points) override { retired_.add(points); }
  /// Nothing is copied but the reports.
  [[nodiscard]] std::shared_ptr<const fem::HeldState> hold() override;
  void return_to(const fem::HeldState& held) override;
  [[nodiscard]] std::vector<io::RveSnapshot> snapshots(std::span<const std::int64_t> points) const override;

  [[nodiscard]] double void_ratio_of(std::size_t rve) const;  ///< of the committed state [-]
  [[nodiscard]] PackedRve packed(std::size_t rve) const;  ///< grains after their last run; another pool may start so

  /// Evaluations pause now and then (piecewise.hpp). Where a pause throws, the committed state is as it was, and the
  /// increment begins anew.
  void set_pause(Pause pause, Watched watched = {}) { pieces_.set_pause(std::move(pause), std::move(watched)); }

  /// The functions from here on are for a pool that is one rank's part of a larger pool, which needs the engine's own
  /// reports and the states of single RVEs. `advance` evaluates as `evaluate` does and leaves the answers in
  /// trial_reports(); without `with_tangents` their tangents are those of eq. (4), which cost nothing.
  kernels::Work advance(std::span<const fem::Gradient> gradients, bool with_tangents);
  [[nodiscard]] const std::vector<kernels::RveReport>& trial_reports() const { return trial_reports_; }
  [[nodiscard]] const std::vector<kernels::RveReport>& committed_reports() const { return committed_reports_; }
  [[nodiscard]] double deferral_error() const { return deferral_.error(); }  ///< of the last evaluation [-]
  [[nodiscard]] double pressure_floor() const {
    return settings_.pressure_floor;
  }  ///< least pressure that the reports' ratios are relative to [Pa]
  /// Says on which device the RVEs reside, or why they do not; empty where there is none to speak of.
  [[nodiscard]] std::string device_sentence() const { return sentence_of(device_); }
  [[nodiscard]] std::uint64_t identity() const { return identity(batch_.packing_of); }
  /// The identity of a larger pool of the same packings, of which this one is a part.
  [[nodiscard]] std::uint64_t identity(std::span<const int> packing_of) const;
  /// The records (state_records.hpp) of these RVEs, in their order, or of `n` RVEs from `first` on.
  [[nodiscard]] std::vector<std::vector<std::byte>> records(std::span<const std::size_t> rves) const;
  [[nodiscard]] std::vector<std::vector<std::byte>> records(std::size_t first, std::size_t n) const;
  /// Gives these records to these RVEs. @throws std::runtime_error where one of them is damaged; all RVEs then keep
  /// the states that they have
  void set_states(std::span<const std::size_t> rves, std::span<const StateRecord> records);

 private:
  EngineCase engine_;
  kernels::EngineSettings settings_;
  kernels::MicrostructureRequest microstructure_;
  DeviceChoice device_;
  kernels::RveBatch batch_;
  std::vector<kernels::StrainRequest> requests_;
  std::vector<kernels::RveReport> trial_reports_;
  std::vector<kernels::RveReport> committed_reports_;
  Deferral deferral_;
  fem::RetiredPoints retired_;
  Piecewise pieces_;
  std::vector<int> running_;              ///< RVEs whose grains the evaluation needs
  std::vector<fem::Gradient> increment_;  ///< of the last evaluation
  bool steps_are_fixed_ = false;
  std::vector<std::size_t> numbers_;                 ///< PackingMix::numbers
  std::vector<double> least_areas_;                  ///< (RVE), see least_areas [m^2]
  std::vector<double> solid_areas_;                  ///< of each packing [m^2]
  std::vector<double> mobilities_;                   ///< mean over the grains of each packing [m/N]
  std::vector<kernels::RveStates> all_states_;       ///< committed, trial and held ones
  std::vector<std::weak_ptr<const HeldRves>> held_;  ///< those that somebody holds, and such as were held

  void reside();
  void start();
  [[nodiscard]] double inertial_time_of(std::size_t rve) const;
  [[nodiscard]] double void_ratio_at(std::size_t rve, double cell_area) const;
  [[nodiscard]] int steps_for(std::size_t rve, const kernels::Mat2& f_rel) const;
  void choose_steps(std::size_t rve, const fem::Gradient& gradient, bool anew);
  void choose_running(std::span<const fem::Gradient> gradients);
  [[nodiscard]] HeldRves committed_rves() const;
  [[nodiscard]] bool is_held(const kernels::RveStates& states);
  [[nodiscard]] kernels::RveStates free_states();
  [[nodiscard]] io::RveSnapshot snapshot(std::size_t rve) const;
};

/// The name of a point's snapshot.
[[nodiscard]] std::string point_name(std::size_t point);

}  // namespace voussoir::host
