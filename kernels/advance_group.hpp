#pragma once
/// One group from its committed states to its trial states: restore, time loop with masked retirement, homogenise, store.

#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "kernels/drives.hpp"
#include "kernels/group_lists.hpp"
#include "kernels/homogenise.hpp"

namespace voussoir::kernels {

/// Members of a group by lane; -1 is an empty lane. All share one packing.
template <int width>
using GroupMembers = std::array<int, static_cast<std::size_t>(width)>;

template <class V, bool Rolling, class Drive>
class GroupAdvance {
 public:
  using real = real_of<V>;
  using Law = LinearContactLaw<V, Rolling>;
  static constexpr std::size_t width = static_cast<std::size_t>(lane_count<V>);

  /// @param requests, reports by RVE
  void run(RveBatch& batch, const GroupMembers<lane_count<V>>& members, std::span<const typename Drive::Request> requests,
           const EngineSettings& settings, std::span<RveReport> reports) {
    batch_ = &batch;
    settings_ = settings;
    packing_ = &batch.packing(static_cast<std::size_t>(members[0]));
    restore(members, requests, reports);
    int step = 0;
    for (; any_running(); ++step) {
      move_cells(step);
      if (step % settings_.list_interval == 0) check_lists();
      if (any_looks(step)) {
        SweepSums<V> sums;
        sweep_pairs<Sweep::measure, Law>(group_, sums);
        judge(step, sums);
      } else {
        SweepSums<V> unused;
        sweep_pairs<Sweep::advance, Law>(group_, unused);
      }
    }
    finish(reports);
  }

 private:
  struct Lane {
    int rve = -1;
    bool running = false;
    RveStatus status = RveStatus::converged;
    int steps = 0;
    double unbalanced = 0;
    Drive drive;
    Mat2 rate;           ///< velocity gradient per step of the coming motion
    Mat2 e;              ///< exp(rate) - I
    Mat2 f_minus_i;      ///< since the last rebase
    double rotation = 0; ///< sum of W per step since the committed state [rad]
  };

  RveBatch* batch_ = nullptr;
  const Packing* packing_ = nullptr;
  EngineSettings settings_;
  double skin_ = 0;
  std::array<Lane, width> lanes_;
  std::array<LaneList<real>, width> lists_;
  GroupState<V> group_;
  UnionBuilder<V> builder_;
  std::vector<std::uint32_t> keys_;
  std::vector<KeptContact> kept_;

  // --- restore -----------------------------------------------------------------------------------------------------

  void restore(const GroupMembers<lane_count<V>>& members, std::span<const typename Drive::Request> requests,
               std::span<RveReport> reports) {
    skin_ = settings_.skin * packing_->mean_diameter();
    group_.n_grains = packing_->size();
    group_.local_damping = packing_->local_damping;
    const auto n = static_cast<std::size_t>(group_.n_grains);
    group_.grains.resize(n);
    group_.shapes.resize(n);
    group_.row.resize(n + 1);
    for (std::size_t i = 0; i < n; ++i) {
      group_.grains[i] = GrainLanes<V>{V(0), V(0), V(0), V(0), V(0), V(0), V(0), V(0), V(0)};
      const double r = packing_->radii[i];
      group_.shapes[i] = {static_cast<real>(r), static_cast<real>(mobility_of(packing_->material, r)),
                          static_cast<real>(rotational_mobility_of(packing_->material, r))};
    }
    for (std::size_t l = 0; l < width; ++l) {
      lanes_[l] = Lane{};
      lists_[l].pairs.clear();
      if (members[l] < 0) continue;
      lanes_[l].rve = members[l];
      reports[static_cast<std::size_t>(members[l])] = RveReport{};
      lanes_[l].drive = Drive(requests[static_cast<std::size_t>(members[l])], *packing_, settings_);
      lanes_[l].running = restore_lane(l);
    }
    builder_.build(group_, lists_, *packing_);
  }

  /// False, with the reason as status, for a lane that cannot run; it stays empty.
  bool restore_lane(std::size_t l) {
    const auto rve = static_cast<std::size_t>(lanes_[l].rve);
    const RveStates& from = batch_->committed;
    LaneList<real>& list = lists_[l];
    const auto n = static_cast<std::size_t>(group_.n_grains);
    list.cell = {from.cell(rve, 0), from.cell(rve, 1), from.cell(rve, 2), from.cell(rve, 3)};
    list.position.assign(&from.position(rve, 0, 0), &from.position(rve, 0, 0) + 2 * n);
    const double sum = std::accumulate(list.position.begin(), list.position.end(), list.cell.norm());
    if (!lanes_[l].drive.possible() || !std::isfinite(sum) || !(list.cell.det() > 0)) {
      lanes_[l].status = RveStatus::not_finite;
      return false;
    }
    auto& cached = batch_->candidates.keys[rve];
    if (batch_->candidates.valid[rve] == 0) {
      find_candidates(list.position, packing_->radii, Cell(list.cell), skin_, cached);
      batch_->candidates.valid[rve] = 1;
    }
    kept_.clear();
    for (std::size_t c = 0; c < static_cast<std::size_t>(from.contact_count(rve)); ++c) {
      kept_.push_back({from.contact_key(rve, c), from.contact_history(rve, c, 0), from.contact_history(rve, c, 1)});
    }
    list_pairs(list, packing_->radii, cached, kept_);
    set_rate(lanes_[l], 0);
    return true;
  }

  // --- time loop ---------------------------------------------------------------------------------------------------

  [[nodiscard]] bool any_running() const {
    for (const Lane& lane : lanes_) {
      if (lane.running) return true;
    }
    return false;
  }

  [[nodiscard]] bool any_looks(int step) const {
    for (const Lane& lane : lanes_) {
      if (lane.running && lane.drive.looks(step)) return true;
    }
    return false;
  }

  static void set_rate(Lane& lane, int step) {
    const Mat2 rate = lane.drive.rate(step);
    if (rate == lane.rate) return;
    lane.rate = rate;
    lane.e = exp_minus_identity(rate);
  }

  /// F <- exp(rate) F in double, then the lanes' rounded copies. A lane that is not running stands still.
  void move_cells(int step) {
    CellMotion<V>& m = group_.motion;
    for (std::size_t l = 0; l < width; ++l) {
      Lane& lane = lanes_[l];
      if (!lane.running) lane.rate = lane.e = Mat2{};
      lane.f_minus_i = lane.e + lane.f_minus_i + lane.e * lane.f_minus_i;
      m.d_xx[l] = static_cast<real>(lane.rate.xx);
      m.d_xy[l] = static_cast<real>(0.5 * (lane.rate.xy + lane.rate.yx));
      m.d_yy[l] = static_cast<real>(lane.rate.yy);
      lane.rotation += 0.5 * (lane.rate.yx - lane.rate.xy);
      if (lane.running) set_rate(lane, step + 1);
      round_motion(l);
    }
  }

  void round_motion(std::size_t l) {
    CellMotion<V>& m = group_.motion;
    const Lane& lane = lanes_[l];
    m.f_xx[l] = static_cast<real>(lane.f_minus_i.xx);
    m.f_xy[l] = static_cast<real>(lane.f_minus_i.xy);
    m.f_yx[l] = static_cast<real>(lane.f_minus_i.yx);
    m.f_yy[l] = static_cast<real>(lane.f_minus_i.yy);
    m.e_xx[l] = static_cast<real>(lane.e.xx);
    m.e_xy[l] = static_cast<real>(lane.e.xy);
    m.e_yx[l] = static_cast<real>(lane.e.yx);
    m.e_yy[l] = static_cast<real>(lane.e.yy);
    m.rotation[l] = static_cast<real>(0.5 * (lane.rate.yx - lane.rate.xy));
    m.alive[l] = lane.running ? real(1) : real(0);
  }

  [[nodiscard]] double volume(std::size_t l) const {
    return ((identity2 + lanes_[l].f_minus_i) * lists_[l].cell).det() * packing_->thickness;
  }

  void judge(int step, const SweepSums<V>& sums) {
    for (std::size_t l = 0; l < width; ++l) {
      Lane& lane = lanes_[l];
      if (!lane.running) continue;
      lane.steps = step + 1;
      if (!lane.drive.looks(step)) continue;
      const double v = volume(l);
      Measurement m{sums.stress_xx[l] / v, sums.stress_yy[l] / v, 0};
      const double p = std::max(-0.5 * (m.stress_xx + m.stress_yy), settings_.pressure_floor);
      m.unbalanced = std::sqrt(static_cast<double>(sums.force_squared[l]) / group_.n_grains) /
                     (p * packing_->thickness * packing_->mean_diameter());
      lane.unbalanced = m.unbalanced;
      const Verdict verdict = lane.drive.judge(step, m);
      if (verdict == Verdict::running) continue;
      freeze(l, verdict == Verdict::converged ? RveStatus::converged : RveStatus::step_limit);
    }
  }

  /// The lane stands still from here on: nothing that later steps do can change it.
  void freeze(std::size_t l, RveStatus status) {
    lanes_[l].running = false;
    lanes_[l].status = status;
    for (GrainLanes<V>& g : group_.grains) {
      g.w_x[l] = g.w_y[l] = g.spin[l] = real(0);
    }
  }

  /// The lane is given up: its numbers leave the group.
  void discard(std::size_t l, RveStatus status) {
    freeze(l, status);
    for (GrainLanes<V>& g : group_.grains) {
      g.u_x[l] = g.u_y[l] = g.force_x[l] = g.force_y[l] = g.torque[l] = real(0);
    }
    lanes_[l].f_minus_i = Mat2{};
    lists_[l].pairs.clear();
  }

  // --- lists -------------------------------------------------------------------------------------------------------

  /// Rebases the lanes whose grains may have met someone they do not list: 2 max|u| + |F - I| (R + skin) >= 0.9 skin.
  void check_lists() {
    V largest(0), finite(0);
    for (const GrainLanes<V>& g : group_.grains) {
      const V squared = fused(g.u_x, g.u_x, g.u_y * g.u_y);
      largest = larger(largest, squared);
      finite = fused(squared, V(0), finite);  // 0, or NaN once any term is not finite
    }
    std::array<bool, width> stale{};
    bool any = false;
    const double reach = 2.0 * packing_->largest_radius() + skin_;
    for (std::size_t l = 0; l < width; ++l) {
      if (!lanes_[l].running) continue;
      const double u = std::sqrt(static_cast<double>(largest[l]));
      const double moved = 2.0 * u + lanes_[l].f_minus_i.norm() * reach;
      const bool lost = !(finite[l] == real(0)) || !std::isfinite(moved);
      if (!lost && moved < 0.9 * skin_) continue;
      stale[l] = any = true;
      if (lost || u > packing_->mean_diameter()) discard(l, lost ? RveStatus::not_finite : RveStatus::overlap_limit);
    }
    if (any) rebuild(stale);
  }

  void rebuild(const std::array<bool, width>& stale) {
    for (std::size_t l = 0; l < width; ++l) {
      if (lanes_[l].rve < 0 || (stale[l] && !lanes_[l].running)) continue;  // empty, or just discarded
      gather_lane(group_, l, lists_[l].pairs);
      if (stale[l]) rebase(l);
    }
    for (std::size_t l = 0; l < width; ++l) round_motion(l);
    builder_.build(group_, lists_, *packing_);
  }

  /// The lane's current configuration becomes its reference.
  void rebase(std::size_t l) {
    LaneList<real>& list = lists_[l];
    kept_.clear();
    for (const ListedPair<real>& p : list.pairs) {
      if (p.tangential != 0 || p.moment != 0) kept_.push_back({p.key, p.tangential, p.moment});
    }
    move_positions(l, list.position);
    const Mat2 f = identity2 + lanes_[l].f_minus_i;
    list.cell = f * list.cell;
    lanes_[l].f_minus_i = Mat2{};
    for (GrainLanes<V>& g : group_.grains) g.u_x[l] = g.u_y[l] = real(0);
    find_candidates(list.position, packing_->radii, Cell(list.cell), skin_, keys_);
    list_pairs(list, packing_->radii, keys_, kept_);
  }

  /// x = F X + u, wrapped into the current cell.
  void move_positions(std::size_t l, std::vector<double>& position) const {
    const Mat2 f = identity2 + lanes_[l].f_minus_i;
    const Cell cell(f * lists_[l].cell);
    for (std::size_t i = 0; i < static_cast<std::size_t>(group_.n_grains); ++i) {
      const double px = position[2 * i], py = position[2 * i + 1];
      double x = f.xx * px + f.xy * py + static_cast<double>(group_.grains[i].u_x[l]);
      double y = f.yx * px + f.yy * py + static_cast<double>(group_.grains[i].u_y[l]);
      cell.wrap(x, y);
      position[2 * i] = x;
      position[2 * i + 1] = y;
    }
  }

  // --- finish ------------------------------------------------------------------------------------------------------

  void finish(std::span<RveReport> reports) {
    for (std::size_t l = 0; l < width; ++l) round_motion(l);
    const Homogenised<V> sums = homogenise<Law>(group_);
    for (std::size_t l = 0; l < width; ++l) {
      if (lanes_[l].rve < 0) continue;
      RveReport& report = reports[static_cast<std::size_t>(lanes_[l].rve)];
      report.status = lanes_[l].status;
      report.steps = lanes_[l].steps;
      report.unbalanced = lanes_[l].unbalanced;
      if (is_failure(report.status)) continue;
      fill_report(l, sums, report);
      if (!is_failure(report.status)) store(l, report);
    }
  }

  void fill_report(std::size_t l, const Homogenised<V>& h, RveReport& report) const {
    const double v = volume(l);
    const double stress[4] = {h.sums.stress_xx[l] / v, h.sums.stress_xy[l] / v, h.sums.stress_yx[l] / v,
                              h.sums.stress_yy[l] / v};
    std::copy_n(stress, 4, report.stress);
    for (std::size_t k = 0; k < 6; ++k) report.tangent[k] = static_cast<double>(h.tangent[k][l]) / v;
    report.contacts = static_cast<int>(h.contacts[l]);
    report.largest_overlap = 1.0 - std::sqrt(1.0 - std::min(1.0, static_cast<double>(h.largest_overlap[l])));
    const double p = std::max(report.pressure(), settings_.pressure_floor);
    report.inertial_number =
        lanes_[l].drive.strain_rate() / std::sqrt(packing_->mean_mobility() * p * packing_->thickness);
    if (!std::isfinite(report.pressure()) || !(v > 0)) {
      report.status = RveStatus::not_finite;
    } else if (!(report.largest_overlap <= settings_.overlap_limit)) {
      report.status = RveStatus::overlap_limit;
    } else if (report.contacts == 0) {
      report.status = RveStatus::open;
    }
  }

  void store(std::size_t l, RveReport& report) {
    const auto rve = static_cast<std::size_t>(lanes_[l].rve);
    RveStates& to = batch_->trial;
    if (report.contacts > to.contact_capacity()) {
      report.status = RveStatus::neighbour_overflow;
      return;
    }
    const Mat2 cell = (identity2 + lanes_[l].f_minus_i) * lists_[l].cell;
    const double h[4] = {cell.xx, cell.xy, cell.yx, cell.yy};
    for (std::size_t k = 0; k < 4; ++k) to.cell(rve, k) = h[k];
    move_positions(l, lists_[l].position);
    std::copy(lists_[l].position.begin(), lists_[l].position.end(), &to.position(rve, 0, 0));
    for (std::size_t i = 0; i < static_cast<std::size_t>(group_.n_grains); ++i) {
      to.rotation(rve, i) = batch_->committed.rotation(rve, i) + lanes_[l].rotation +
                            static_cast<double>(group_.grains[i].rotation[l]);
    }
    store_contacts(l, rve);
  }

  void store_contacts(std::size_t l, std::size_t rve) {
    RveStates& to = batch_->trial;
    int count = 0;
    for (std::size_t i = 0; i < group_.grains.size(); ++i) {
      const GrainLanes<V>& gi = group_.grains[i];
      for (auto p = static_cast<std::size_t>(group_.row[i]); p < static_cast<std::size_t>(group_.row[i + 1]); ++p) {
        const int j = group_.pair_shapes[p].other;
        const GrainLanes<V>& gj = group_.grains[static_cast<std::size_t>(j)];
        const PairLanes<V>& pair = group_.pairs[p];
        const auto at = geometry_of(pair, group_.motion, gj.u_x - gi.u_x, gj.u_y - gi.u_y);
        if (!(at.gap[l] < real(0))) continue;
        to.contact_key(rve, count) = pair_key(static_cast<int>(i), j);
        to.contact_history(rve, count, 0) = pair.tangential[l];
        to.contact_history(rve, count, 1) = pair.moment[l];
        ++count;
      }
    }
    to.contact_count(rve) = count;
  }
};

}  // namespace voussoir::kernels
