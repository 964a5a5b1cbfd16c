#pragma once
/// Many steps of one RVE by one team of threads: pair state in registers, grains and actions in shared memory, two
/// barriers a step, sums in a fixed order, no atomic operations. The team is a block of a graphics card (cuda_team.hpp)
/// or threads of a host (threads_team.hpp).

#include "tests/benchmark/gpu_step/look.hpp"

namespace voussoir::gpu_step {

/// One thread's share of an RVE.
template <class Instance, class Team>
class StepThread {
 public:
  using Real = typename Instance::Real;

  VOUSSOIR_DEVICE StepThread(const Team& team, const StepArguments<Real>& a) : team_(team), a_(a) {
    Carver carver(team.shared());
    m_ = carve_step<Instance>(carver, a.grains, a.lists.capacity);
    first_ = static_cast<std::size_t>(team.rve()) * static_cast<std::size_t>(a.lists.capacity);
    row_first_ = static_cast<std::size_t>(team.rve()) * static_cast<std::size_t>(a.grains + 1);
    pairs_ = a.lists.pair_count[team.rve()];
    growth_ = a.growth[team.rve()];
  }

  VOUSSOIR_DEVICE void run() {
    if (pairs_ > a_.lists.capacity) return;
    load();
    int step = 0;
    while (step < a_.steps) {
      const int plain_end = Instance::look == Look::peeled && step + a_.look_every <= a_.steps
                                ? step + a_.look_every - 1
                                : a_.steps;
      for (; step < plain_end; ++step) {
        one_step<false>(step);
        if (Instance::look == Look::called && is_look(step) && m_.sums.report->force_squared < a_.rest) break;
      }
      if (step == a_.steps || Instance::look != Look::peeled) break;
      one_step<true>(step++);
      if (m_.sums.report->force_squared < a_.rest) break;
    }
    store();
  }

 private:
  static constexpr int threads = Team::threads, S = Instance::pair_slots, G = Instance::grain_slots;

  [[nodiscard]] VOUSSOIR_DEVICE bool is_look(int step) const { return (step + 1) % a_.look_every == 0; }

  VOUSSOIR_DEVICE void load() {
    const int rank = team_.rank();
    const PairLists<Real>& l = a_.lists;
    VOUSSOIR_UNROLL
    for (int k = 0; k < S; ++k) {
      const int p = k * threads + rank;
      if (p >= pairs_) continue;
      const std::size_t at = first_ + static_cast<std::size_t>(p);
      pair_[k] = {l.branch_x[at], l.branch_y[at], l.gap[at], l.tangential[at], l.moment[at], l.grains[at]};
    }
    for (int i = rank; i < a_.grains; i += threads) {
      m_.s.grain[i] = {0, 0, 0, 0};
      m_.s.spin_radius[i] = {0, a_.radius[i]};
    }
    VOUSSOIR_UNROLL
    for (int g = 0; g < G; ++g) rotation_[g] = 0;
    load_gather();
    if (rank == 0) {
      m_.s.action[l.capacity] = {0, 0, 0, 0};
      *m_.cell = {0, 0, 0, 0};
      if constexpr (Instance::look != Look::none) *m_.sums.report = LookReport{};
      m_.motion[0] = m_.motion[1] = Motion<Real>{};
      move_cell(*m_.cell, growth_, m_.motion[0]);
    }
    team_.barrier();
  }

  VOUSSOIR_DEVICE void load_gather() {
    const std::uint16_t *const row = a_.lists.row + row_first_, *const in_row = a_.lists.incoming_row + row_first_;
    const std::uint16_t* const incoming = a_.lists.incoming + first_;
    if constexpr (Instance::gather == Gather::two_loops) {
      for (int i = team_.rank(); i <= a_.grains; i += threads) {
        m_.s.row[i] = row[i];
        m_.s.incoming_row[i] = in_row[i];
      }
      for (int p = team_.rank(); p < pairs_; p += threads) m_.s.indices[p] = incoming[p];
    } else if constexpr (Instance::gather == Gather::one_list) {
      for (int i = team_.rank(); i <= a_.grains; i += threads) {
        m_.s.row[i] = static_cast<std::uint16_t>(row[i] + in_row[i]);
      }
      for (int i = team_.rank(); i < a_.grains; i += threads) {
        int to = row[i] + in_row[i];
        for (int k = in_row[i]; k < in_row[i + 1]; ++k) {
          m_.s.indices[to++] = static_cast<std::uint16_t>(incoming[k] | is_incoming);
        }
        for (int p = row[i]; p < row[i + 1]; ++p) m_.s.indices[to++] = static_cast<std::uint16_t>(p);
      }
    } else {
      VOUSSOIR_UNROLL
      for (int g = 0; g < G; ++g) {
        const int i = g * threads + team_.rank();
        const int in_first = i < a_.grains ? in_row[i] : 0, in = i < a_.grains ? in_row[i + 1] - in_first : 0;
        const int own_first = i < a_.grains ? row[i] : 0, own = i < a_.grains ? row[i + 1] - own_first : 0;
        VOUSSOIR_UNROLL
        for (int k = 0; k < most_in_registers; k += 2) {
          near_[g * words + k / 2] = near_index(k, in, own, in_first, own_first) |
                                     near_index(k + 1, in, own, in_first, own_first) << 16;
        }
      }
    }
  }

  /// Entry k of a grain with `in` incoming pairs and `own` pairs of its row; the index of a zero action behind them.
  [[nodiscard]] VOUSSOIR_DEVICE std::uint32_t near_index(int k, int in, int own, int in_first, int own_first) const {
    if (k < in) return a_.lists.incoming[first_ + static_cast<std::size_t>(in_first + k)] | is_incoming;
    return static_cast<std::uint32_t>(k < in + own ? own_first + k - in : a_.lists.capacity);
  }

  template <bool looks>
  VOUSSOIR_DEVICE void one_step(int step) {
    const int rank = team_.rank();
    const Motion<Real> c = m_.motion[step & 1];
    VOUSSOIR_UNROLL
    for (int k = 0; k < S; ++k) {
      const int p = k * threads + rank;
      Stress<Real> own{0, 0, 0, 0};
      if (p < pairs_) own = pair_step<Instance::rolling, Instance::branch>(m_.s, pair_[k], p, c, a_.material);
      if constexpr (looks) sum_pairs(team_, m_.sums, k * (threads / 32) + rank / 32, own);
    }
    team_.barrier();
    if constexpr (Instance::look == Look::called) {
      if (is_look(step)) look_from_list<Instance>(team_, a_, step & 1);
    }
    if (rank == threads - 32) move_cell(*m_.cell, growth_, m_.motion[(step + 1) & 1]);
    VOUSSOIR_UNROLL
    for (int g = 0; g < G; ++g) {
      const int i = g * threads + rank;
      Real own = 0;
      if (i < a_.grains) own = move_grain(m_.s, i, rotation_[g], gather(g, i), c, a_.material);
      if constexpr (looks) sum_grains(team_, m_.sums, g * (threads / 32) + rank / 32, own);
    }
    team_.barrier();
    if constexpr (looks) {
      sum_chunks(team_, m_.sums);
      team_.barrier();
    }
  }

  /// Sums in the order of the list: incoming pairs, then own ones.
  [[nodiscard]] VOUSSOIR_DEVICE Load<Real> gather(int g, int i) const {
    Load<Real> load;
    if constexpr (Instance::gather == Gather::two_loops) {
      const int in_end = m_.s.incoming_row[i + 1], end = m_.s.row[i + 1];
      for (int k = m_.s.incoming_row[i]; k < in_end; ++k) load.add(m_.s.action[m_.s.indices[k]], true);
      for (int p = m_.s.row[i]; p < end; ++p) load.add(m_.s.action[p], false);
    } else if constexpr (Instance::gather == Gather::one_list) {
      const int end = m_.s.row[i + 1];
      for (int k = m_.s.row[i]; k < end; ++k) {
        const std::uint32_t x = m_.s.indices[k];
        load.add(m_.s.action[pair_of(x)], (x & is_incoming) != 0);
      }
    } else {
      VOUSSOIR_UNROLL
      for (int h = 0; h < words; ++h) {  // two loads are under way before the sums wait for them
        const std::uint32_t both = near_[g * words + h], x0 = both & 0xffffU, x1 = both >> 16;
        if (h > 1 && pair_of(x0) == a_.lists.capacity) break;
        const Quad<Real> y0 = m_.s.action[pair_of(x0)], y1 = m_.s.action[pair_of(x1)];
        load.add(y0, (x0 & is_incoming) != 0);
        load.add(y1, (x1 & is_incoming) != 0);
      }
    }
    return load;
  }

  VOUSSOIR_DEVICE void store() {
    const int rank = team_.rank();
    const auto grain_first = static_cast<std::size_t>(team_.rve()) * static_cast<std::size_t>(a_.grains);
    VOUSSOIR_UNROLL
    for (int g = 0; g < G; ++g) {
      const int i = g * threads + rank;
      if (i >= a_.grains) continue;
      a_.state[grain_first + static_cast<std::size_t>(i)] = m_.s.grain[i];
      a_.spin[grain_first + static_cast<std::size_t>(i)] = {m_.s.spin_radius[i].x, rotation_[g]};
    }
    VOUSSOIR_UNROLL
    for (int k = 0; k < S; ++k) {
      const int p = k * threads + rank;
      if (p >= pairs_) continue;
      a_.lists.tangential[first_ + static_cast<std::size_t>(p)] = pair_[k].tangential;
      a_.lists.moment[first_ + static_cast<std::size_t>(p)] = pair_[k].moment;
    }
    if constexpr (Instance::look != Look::none) {
      if (rank == 0) a_.report[team_.rve()] = *m_.sums.report;
    }
  }

  static constexpr std::uint32_t is_incoming = 0x8000;
  [[nodiscard]] static VOUSSOIR_DEVICE int pair_of(std::uint32_t index) {
    return static_cast<int>(index & static_cast<std::uint32_t>(most_pairs));
  }
  static constexpr int words = most_in_registers / 2;

  const Team& team_;
  const StepArguments<Real>& a_;
  StepMemory<Real> m_;
  std::size_t first_, row_first_;
  int pairs_;
  Mat2 growth_;
  Pair<Real> pair_[S];
  Real rotation_[G];
  std::uint32_t near_[Instance::gather == Gather::in_registers ? G * words : 1];
};

}  // namespace voussoir::gpu_step
