// The contact law and the integrator as the GPU runs them: one team per RVE, its state in team scratch, one lane. Here
// a team holds a row of overlapping grains that is sheared; the device must give what the host gives.

#include <Kokkos_Core.hpp>
#include <cmath>
#include <cstdio>

#include "kernels/contact/engine_law.hpp"
#include "kernels/contact/grain_motion.hpp"
#include "kernels/contact/pair_forces.hpp"
#include "kernels/contact/pair_reference.hpp"

namespace {

using namespace voussoir::kernels;

constexpr int n_rves = 64;
constexpr int n_grains = 8;
constexpr int n_steps = 200;
constexpr double radius = 1.7e-3;      // [m]
constexpr double overlap = 1.0e-6;     // of neighbours at the start [m]
constexpr double shear_step = 1.0e-6;  // F_xy per step [-]

/// State of one RVE in team scratch. The list is full, (i, j) and (j, i): no thread writes to another's grain.
template <class Law, class Space>
struct Scratch {
  using V = typename Law::Value;
  using Memory = typename Space::scratch_memory_space;
  using Grains = Kokkos::View<GrainLanes<V>*, Memory, Kokkos::MemoryUnmanaged>;
  using Pairs = Kokkos::View<PairLanes<Law>**, Kokkos::LayoutRight, Memory, Kokkos::MemoryUnmanaged>;
  Grains grains;
  Pairs pairs;

  template <class Member>
  KOKKOS_FUNCTION explicit Scratch(const Member& team)
      : grains(team.team_scratch(0), n_grains), pairs(team.team_scratch(0), n_grains, n_grains) {}

  static std::size_t bytes() { return Grains::shmem_size(n_grains) + Pairs::shmem_size(n_grains, n_grains); }
};

template <class V, bool Rolling, class Space>
struct ShearRow {
  using real = real_of<V>;
  using Law = EngineLaw<V, Rolling>;
  using Policy = Kokkos::TeamPolicy<Space>;
  using Member = typename Policy::member_type;

  PairShape<Law> pair_shape;
  GrainShape<real> grain_shape;
  Kokkos::View<double***, Kokkos::LayoutRight, typename Space::memory_space> result;  ///< (RVE, grain, u_x u_y
                                                                                      ///< rotation)

  KOKKOS_FUNCTION void operator()(const Member& team) const {
    const Scratch<Law, Space> state(team);
    const auto each_grain = Kokkos::TeamThreadRange(team, n_grains);
    Kokkos::parallel_for(each_grain, [&](int i) { start(state, i, team.league_rank()); });
    team.team_barrier();
    CellMotion<V> cell{};
    cell.alive = V(1);
    cell.d_xy = V(real(0.5 * shear_step));
    cell.e_xy = V(real(shear_step));
    cell.rotation = V(real(-0.5 * shear_step));
    for (int step = 1; step <= n_steps; ++step) {
      cell.f_xy = V(real(step * shear_step));
      Kokkos::parallel_for(each_grain, [&](int i) { gather(state, cell, i); });
      team.team_barrier();
      Kokkos::parallel_for(each_grain, [&](int i) { move(state, cell, i); });
      team.team_barrier();
    }
    Kokkos::parallel_for(each_grain, [&](int i) { store(state, i, team.league_rank()); });
  }

  /// Grains in a row along (1, 1), each RVE a little more compressed than the one before.
  KOKKOS_FUNCTION void start(const Scratch<Law, Space>& state, int i, int rve) const {
    state.grains(i) = GrainLanes<V>{};
    const double distance = 2.0 * radius - overlap * (1.0 + 0.01 * rve);
    for (int j = 0; j < n_grains; ++j) {
      PairLanes<Law> pair{};
      pair.history = no_history<Law>();
      const double branch = (j - i) * distance / Kokkos::sqrt(2.0);
      pair.branch_x = pair.branch_y = V(static_cast<real>(branch));
      pair.gap = V(static_cast<real>(2.0 * branch * branch - 4.0 * radius * radius));
      state.pairs(i, j) = pair;
    }
  }

  KOKKOS_FUNCTION void gather(const Scratch<Law, Space>& state, const CellMotion<V>& cell, int i) const {
    GrainLanes<V>& gi = state.grains(i);
    for (int j = 0; j < n_grains; ++j) {
      if (j == i) continue;
      const GrainLanes<V>& gj = state.grains(j);
      PairLanes<Law>& pair = state.pairs(i, j);
      const PairGeometry<V> at = geometry_of(pair, cell, gj.u_x - gi.u_x, gj.u_y - gi.u_y);
      const PairAction<V> action = act(pair, pair_shape, at, cell, gj.w_x - gi.w_x, gj.w_y - gi.w_y,
                                       rim_of(V(grain_shape.radius), gi.spin), gj.spin);
      gi.force_x = gi.force_x + action.force_x;
      gi.force_y = gi.force_y + action.force_y;
      gi.torque = gi.torque + action.torque_i;
    }
  }

  KOKKOS_FUNCTION void move(const Scratch<Law, Space>& state, const CellMotion<V>& cell, int i) const {
    GrainLanes<V>& grain = state.grains(i);
    const V fx = grain.force_x, fy = grain.force_y, torque = grain.torque;
    integrate(grain, grain_shape, cell, V(real(0.3)), fx, fy, torque);
  }

  KOKKOS_FUNCTION void store(const Scratch<Law, Space>& state, int i, int rve) const {
    result(rve, i, 0) = static_cast<double>(state.grains(i).u_x[0]);
    result(rve, i, 1) = static_cast<double>(state.grains(i).u_y[0]);
    result(rve, i, 2) = static_cast<double>(state.grains(i).rotation[0]);
  }
};

template <class V, bool Rolling, class Space>
auto shear_row() {
  using real = real_of<V>;
  const GrainMaterial sand;
  using Law = EngineLaw<V, Rolling>;
  const PairShape<Law> pair = pair_shape<Law>(0, sand, radius, sand, radius);
  const double a = 0.1 / Law::normal_stiffness_of(sand, radius, 0.0);  // a tenth of the squared stable step
  const GrainShape<real> grain{real(radius), real(a), real(2.0 * a / (radius * radius)), real(0.5 * a),
                               real(a / (radius * radius))};

  using Functor = ShearRow<V, Rolling, Space>;
  const Functor functor{.pair_shape = pair,
                        .grain_shape = grain,
                        .result = decltype(Functor::result)("voussoir::law_compile_test::result", n_rves, n_grains, 3)};
  auto policy = typename Functor::Policy(Space(), n_rves, Kokkos::AUTO);
  policy.set_scratch_size(0, Kokkos::PerTeam(Scratch<Law, Space>::bytes()));
  Kokkos::parallel_for("voussoir::law_compile_test::shear_row", policy, functor);
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), functor.result);
}

/// Largest difference between device and host over the largest value, all RVEs and grains; infinite when nothing moved.
template <class real, bool Rolling>
double device_against_host() {
  using V = SingleLane<real>;
  const auto device = shear_row<V, Rolling, Kokkos::DefaultExecutionSpace>();
  const auto host = shear_row<V, Rolling, Kokkos::Serial>();
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < host.size(); ++n) {
    largest = std::fmax(largest, std::abs(host.data()[n]));
    const double d = std::abs(device.data()[n] - host.data()[n]);
    difference = d <= difference ? difference : d;  // keeps a NaN
  }
  return difference / largest;
}

bool report(const char* what, double error, double tolerance) {
  std::printf("%-22s device against host: %.2e (at most %.0e)\n", what, error, tolerance);
  return error <= tolerance;
}

}  // namespace

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  // The compilers of host and device contract differently: rounding, amplified by 200 steps.
  bool passed = report("double", device_against_host<double, false>(), 1e-10);
  passed = report("double, with rolling", device_against_host<double, true>(), 1e-10) && passed;
  passed = report("float", device_against_host<float, false>(), 1e-3) && passed;
  passed = report("float, with rolling", device_against_host<float, true>(), 1e-3) && passed;
  return passed ? 0 : 1;
}
