#pragma once
/// The same lists and steps by one thread of the host: all pairs are tried, and nothing is shared. A team must have the
/// bits of these functions.

#include <algorithm>
#include <array>
#include <vector>

#include "tests/benchmark/gpu_step/lists.hpp"
#include "tests/benchmark/gpu_step/step.hpp"
#include "tests/benchmark/gpu_step/threads_team.hpp"

namespace voussoir::gpu_step {

/// An RVE at rest as it comes from a packing file (packing_file.hpp).
struct Rve {
  Mat2 cell;                         ///< columns are the periodic vectors [m]
  double skin;                       ///< [m]
  std::vector<double> position;      ///< (grain, 2) [m]
  std::vector<double> radius;        ///< (grain) [m]
  std::vector<std::uint32_t> kept;   ///< contacts, ascending i << 16 | j
  std::vector<Two<double>> history;  ///< of the contacts: tangential force [N], rolling moment [N m]

  [[nodiscard]] int grains() const { return static_cast<int>(radius.size()); }
};

/// Memory for the lists of several RVEs.
template <class Real>
struct ListStore {
  int capacity;
  std::vector<Real> branch_x, branch_y, gap, tangential, moment;
  std::vector<std::uint32_t> grains;
  std::vector<std::uint16_t> row, incoming_row, incoming;
  std::vector<int> pair_count;

  ListStore(int rves, int grain_count, int pair_capacity) : capacity(pair_capacity) {
    const auto pairs = static_cast<std::size_t>(rves) * static_cast<std::size_t>(pair_capacity);
    const auto rows = static_cast<std::size_t>(rves) * static_cast<std::size_t>(grain_count + 1);
    for (auto* v : {&branch_x, &branch_y, &gap, &tangential, &moment}) v->resize(pairs);
    grains.resize(pairs);
    incoming.resize(pairs);
    row.resize(rows);
    incoming_row.resize(rows);
    pair_count.resize(static_cast<std::size_t>(rves));
  }

  PairLists<Real> lists() {
    return {capacity,      branch_x.data(), branch_y.data(),     gap.data(),      tangential.data(), moment.data(),
            grains.data(), row.data(),      incoming_row.data(), incoming.data(), pair_count.data()};
  }
};

/// Whether RVE `rve` of `many` has the bits of the only RVE of `one`, but for the sign of zeros: a pair that does not
/// touch forgets its histories either by a zero or by a cap of zero.
template <class Real>
bool same_list(const ListStore<Real>& many, int rve, const ListStore<Real>& one, int grains) {
  const int pairs = one.pair_count[0];
  const auto same = [](const auto& a, std::size_t first, const auto& b, int count) {  // a NaN is never the same
    return std::equal(b.begin(), b.begin() + count, a.begin() + static_cast<std::ptrdiff_t>(first));
  };
  const auto first = static_cast<std::size_t>(rve) * static_cast<std::size_t>(many.capacity);
  const auto row_first = static_cast<std::size_t>(rve) * static_cast<std::size_t>(grains + 1);
  return many.pair_count[static_cast<std::size_t>(rve)] == pairs && same(many.grains, first, one.grains, pairs) &&
         same(many.branch_x, first, one.branch_x, pairs) && same(many.branch_y, first, one.branch_y, pairs) &&
         same(many.gap, first, one.gap, pairs) && same(many.tangential, first, one.tangential, pairs) &&
         same(many.moment, first, one.moment, pairs) && same(many.incoming, first, one.incoming, pairs) &&
         same(many.row, row_first, one.row, grains + 1) &&
         same(many.incoming_row, row_first, one.incoming_row, grains + 1);
}

/// All pairs closer than r_i + r_j + skin, in the order of the list.
inline std::vector<std::uint32_t> near_pairs(const Rve& rve) {
  const Grid grid(rve.cell, rve.grains());
  std::vector<std::uint32_t> keys;
  for (std::size_t i = 0; i < rve.radius.size(); ++i) {
    for (std::size_t j = i + 1; j < rve.radius.size(); ++j) {
      double dx = rve.position[2 * j] - rve.position[2 * i], dy = rve.position[2 * j + 1] - rve.position[2 * i + 1];
      grid.nearest(dx, dy);
      const double reach = rve.radius[i] + rve.radius[j] + rve.skin;
      if (dx * dx + dy * dy < reach * reach) keys.push_back(static_cast<std::uint32_t>(i << 16 | j));
    }
  }
  return keys;
}

/// The list of one RVE with room for `capacity` pairs.
template <class Real>
ListStore<Real> reference_list(const Rve& rve, int capacity) {
  const Grid grid(rve.cell, rve.grains());
  const std::vector<std::uint32_t> keys = near_pairs(rve);
  const auto n = static_cast<std::size_t>(rve.grains());
  ListStore<Real> list(1, rve.grains(), capacity);
  list.pair_count[0] = static_cast<int>(keys.size());
  if (list.pair_count[0] > capacity) return list;
  std::vector<std::vector<std::uint16_t>> incoming(n);
  std::size_t kept = 0;
  for (std::size_t p = 0; p < keys.size(); ++p) {
    const std::size_t i = keys[p] >> 16, j = keys[p] & 0xffffU;
    double dx = rve.position[2 * j] - rve.position[2 * i], dy = rve.position[2 * j + 1] - rve.position[2 * i + 1];
    grid.nearest(dx, dy);
    const double sum = rve.radius[i] + rve.radius[j];
    list.grains[p] = keys[p];
    list.branch_x[p] = static_cast<Real>(dx);
    list.branch_y[p] = static_cast<Real>(dy);
    list.gap[p] = static_cast<Real>(dx * dx + dy * dy - sum * sum);
    while (kept < rve.kept.size() && rve.kept[kept] < keys[p]) ++kept;
    const bool known = kept < rve.kept.size() && rve.kept[kept] == keys[p];
    list.tangential[p] = known ? static_cast<Real>(rve.history[kept].x) : Real(0);
    list.moment[p] = known ? static_cast<Real>(rve.history[kept].y) : Real(0);
    ++list.row[i + 1];
    incoming[j].push_back(static_cast<std::uint16_t>(p));
  }
  std::size_t at = 0;
  for (std::size_t i = 0; i < n; ++i) {
    list.row[i + 1] = static_cast<std::uint16_t>(list.row[i + 1] + list.row[i]);
    for (const std::uint16_t p : incoming[i]) list.incoming[at++] = p;
    list.incoming_row[i + 1] = static_cast<std::uint16_t>(at);
  }
  return list;
}

/// The most pairs of one grain.
template <class Real>
int most_pairs_of_a_grain(const ListStore<Real>& list, int grains) {
  int result = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(grains); ++i) {
    const int own = list.row[i + 1] - list.row[i] + list.incoming_row[i + 1] - list.incoming_row[i];
    result = own > result ? own : result;
  }
  return result;
}

/// State of one RVE after its steps, as StepArguments has it.
template <class Real>
struct StepState {
  std::vector<Quad<Real>> state;
  std::vector<Two<Real>> spin;
  LookReport report{};
};

/// Sums of chunks of 32, then of the chunks by the lanes of a warp.
template <class Real>
double look_sum(std::vector<Real> x) {
  x.resize((x.size() + 31) / 32 * 32, Real(0));
  std::array<double, 32> lanes{};
  for (std::size_t chunk = 0; chunk < x.size() / 32; ++chunk) {
    std::array<Real, 32> part;
    for (std::size_t k = 0; k < 32; ++k) part[k] = x[32 * chunk + k];
    lanes[chunk % 32] += sum_by_halves(part);
  }
  return sum_by_halves(lanes);
}

/// `steps` steps from `list`, whose histories go on. @param look_every 0 for no look
template <bool rolling, class Real>
StepState<Real> reference_steps(ListStore<Real>& list, const std::vector<double>& radius, const Mat2& growth,
                                const Material<Real>& material, int steps, int look_every) {
  const std::size_t n = radius.size(), pairs = static_cast<std::size_t>(list.pair_count[0]);
  StepState<Real> r{std::vector<Quad<Real>>(n), std::vector<Two<Real>>(n)};
  std::vector<Quad<Real>> action(pairs);
  std::vector<Two<Real>> spin_radius(n);
  std::vector<Real> rotation(n, 0);
  for (std::size_t i = 0; i < n; ++i) spin_radius[i] = {0, static_cast<Real>(radius[i])};
  const Shared<Real> s{r.state.data(), spin_radius.data(), action.data(), nullptr, nullptr, nullptr};
  Mat2 f{0, 0, 0, 0};
  Motion<Real> motion{};
  std::array<std::vector<Real>, 4> stress;
  for (auto& one : stress) one.resize(pairs);
  std::vector<Real> squared(n);
  for (int step = 0; step < steps; ++step) {
    move_cell(f, growth, motion);
    for (std::size_t p = 0; p < pairs; ++p) {
      Pair<Real> pair{list.branch_x[p],   list.branch_y[p], list.gap[p],
                      list.tangential[p], list.moment[p],   list.grains[p]};
      const Stress<Real> of = pair_step<rolling, true>(s, pair, static_cast<int>(p), motion, material);
      list.tangential[p] = pair.tangential;
      list.moment[p] = pair.moment;
      stress[0][p] = of.xx, stress[1][p] = of.xy, stress[2][p] = of.yx, stress[3][p] = of.yy;
    }
    for (std::size_t i = 0; i < n; ++i) {
      Load<Real> load;
      for (int k = list.incoming_row[i]; k < list.incoming_row[i + 1]; ++k) {
        load.add(action[list.incoming[static_cast<std::size_t>(k)]], true);
      }
      for (std::size_t p = list.row[i]; p < list.row[i + 1]; ++p) load.add(action[p], false);
      squared[i] = move_grain(s, static_cast<int>(i), rotation[i], load, motion, material);
    }
    if (look_every > 0 && (step + 1) % look_every == 0) {
      r.report = {{look_sum(stress[0]), look_sum(stress[1]), look_sum(stress[2]), look_sum(stress[3])},
                  look_sum(squared)};
    }
  }
  for (std::size_t i = 0; i < n; ++i) r.spin[i] = {spin_radius[i].x, rotation[i]};
  return r;
}

/// Literal coarse sand (Table 1's first class) at the step that is 0.9 of the stable one, damping 0.3.
template <class Real>
Material<Real> literal_sand() {
  constexpr double E = 3e9, k = 0.5, beta = 1.0, safety = 0.81;
  return {.modulus2 = Real(2 * E),
          .stiffness_ratio = Real(k),
          .rolling = Real(beta),
          .friction = Real(0.466307658),
          .rolling_limit = Real(0.6),
          .mobility = Real(safety * 4 / (6 * E * (1 + 2 * k))),
          .spin_mobility = Real(0.2 * safety * 4 / (6 * (4 + 2 * beta) * k * E)),
          .damping = Real(0.3)};
}

/// RVE v's growth of the cell a step: a strain of its own, of constant area in the first order.
inline Mat2 growth_of(int rve) {
  const double g = 2e-7 * std::cos(0.1 * rve);
  return {g, 0.5 * g, 0.5 * g, -g};
}

/// RVE v: the same packing, moved, so that its bins are others.
inline Rve moved(const Rve& rve, int v) {
  Rve r = rve;
  const double a = std::fmod(0.618 * v, 1.0), b = std::fmod(0.414 * v, 1.0);
  const Grid grid(rve.cell, rve.grains());
  for (std::size_t i = 0; i < r.radius.size(); ++i) {
    double &x = r.position[2 * i], &y = r.position[2 * i + 1];
    x += r.cell.xx * a + r.cell.xy * b;
    y += r.cell.yx * a + r.cell.yy * b;
    grid.wrap(x, y);
  }
  return r;
}

}  // namespace voussoir::gpu_step
