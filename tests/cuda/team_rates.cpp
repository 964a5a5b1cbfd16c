/// The team kernel on a device: its rates, and its bits against the lanes and against itself (README.md).
/// usage: team_rates rates PACKING RVES...    steps alone, kernel and whole calls, by threads of a team
///        team_rates looks PACKING RVES...    what a look during a hold costs
///        team_rates check PACKING RVES       which RVEs have all bits of the lanes, and of teams of other sizes
///        team_rates once PACKING RVES STEPS THREADS float|double    one call, for profilers and sanitizers

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "kernels/advance_rves.hpp"
#include "tests/benchmark/gpu_step/packing_file.hpp"

namespace voussoir::kernels {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// The time of the team kernel itself, by callbacks of Kokkos with a fence at its begin and at its end.
struct KernelClock {
  double seconds = 0;
  Clock::time_point start;
  bool inside = false;
};
KernelClock kernel_clock;

void begin_kernel(const char* name, std::uint32_t /*device*/, std::uint64_t* /*id*/) {
  if (std::strstr(name, "advance") == nullptr) return;
  Kokkos::fence();
  kernel_clock.inside = true;
  kernel_clock.start = Clock::now();
}

void end_kernel(std::uint64_t /*id*/) {
  if (!kernel_clock.inside) return;
  kernel_clock.inside = false;
  Kokkos::fence();
  kernel_clock.seconds += seconds_since(kernel_clock.start);
}

/// Copies of a packing of one class of grains, the literal one.
RveBatch copies(const gpu_step::Rve& rve, std::size_t count) {
  Packing packing;
  packing.radii = rve.radius;
  RveBatch batch = make_batch({packing}, std::vector<int>(count, 0));
  RveStates& state = batch.committed;
  for (std::size_t v = 0; v < count; ++v) {
    for (std::size_t i = 0; i < rve.radius.size(); ++i) {
      state.position(v, i, 0) = rve.position[2 * i];
      state.position(v, i, 1) = rve.position[2 * i + 1];
      state.rotation(v, i) = 0;
    }
    const double cell[] = {rve.cell.xx, rve.cell.xy, rve.cell.yx, rve.cell.yy};
    for (std::size_t c = 0; c < 4; ++c) state.cell(v, c) = cell[c];
    for (std::size_t c = 0; c < rve.kept.size(); ++c) {
      state.contact_key(v, c) = rve.kept[c];
      state.contact_history(v, c, 0) = rve.history[c].x;
      state.contact_history(v, c, 1) = rve.history[c].y;
    }
    state.contact_count(v) = static_cast<int>(rve.kept.size());
  }
  forget_candidates(batch);
  return batch;
}

/// Each RVE has a strain of its own, 2.5e-6 a step at most.
std::vector<StrainRequest> requests(std::size_t count, int steps, int hold) {
  std::vector<StrainRequest> all(count);
  for (std::size_t v = 0; v < count; ++v) {
    const double e = 2.5e-6 * steps * std::cos(0.1 * static_cast<double>(v));
    all[v] = {.f_rel = {1 + e, e, 0, 1 - e}, .strain_steps = steps, .hold_cap = hold};
  }
  return all;
}

EngineSettings team_settings(Precision precision, int threads, double hold_tolerance) {
  return {.precision = precision, .hold_tolerance = hold_tolerance, .backend = Backend::teams, .team_size = threads};
}

struct Timed {
  double call = 1e30, kernel = 1e30;  ///< shortest of the repeats [s]
  std::size_t work = 0;               ///< particle-steps
};

constexpr int repeats = 2;
constexpr double never = 1e-12;  ///< a hold to this tolerance goes on to its cap

Timed timed(RveBatch& batch, Precision precision, int threads, int steps, int hold) {
  const auto asked = requests(batch.size(), steps, hold);
  std::vector<RveReport> reports(batch.size());
  Timed best;
  for (int r = 0; r < repeats; ++r) {
    kernel_clock.seconds = 0;
    const auto start = Clock::now();
    best.work = advance(batch, std::span<const StrainRequest>(asked), team_settings(precision, threads, never), reports)
                    .particle_steps;
    best.call = std::min(best.call, seconds_since(start));
    best.kernel = std::min(best.kernel, kernel_clock.seconds);
  }
  return best;
}

const char* name_of(Precision precision) { return precision == Precision::float32 ? "float" : "double"; }

constexpr Precision precisions[] = {Precision::float32, Precision::float64};

void rates(const gpu_step::Rve& rve, std::size_t count) {
  constexpr int few = 10, many = 410;
  RveBatch batch = copies(rve, count);
  for (const Precision precision : precisions) {
    for (const int threads : {0, 64, 128, 192, 256, 384}) {  // 0: what Kokkos chooses
      std::printf("%5d grains %5zu RVEs %-6s team of %3d | ", rve.grains(), count, name_of(precision), threads);
      try {
        const Timed a = timed(batch, precision, threads, few, 1), b = timed(batch, precision, threads, many, 1);
        const double more = b.kernel - a.kernel;
        std::printf(
            "calls %8.2f and %8.2f ms, kernels %8.2f and %8.2f ms | G/s: call %7.3f, kernel %7.3f, steps alone %7.3f | "
            "%7.2f us a step\n",
            1e3 * a.call, 1e3 * b.call, 1e3 * a.kernel, 1e3 * b.kernel, 1e-9 * static_cast<double>(b.work) / b.call,
            1e-9 * static_cast<double>(b.work) / b.kernel, 1e-9 * static_cast<double>(b.work - a.work) / more,
            1e6 * more / (many - few));
      } catch (const std::exception& e) {  // a team of so many threads may need too many registers
        std::printf("%s\n", e.what());
      }
      std::fflush(stdout);
    }
  }
}

/// A hold looks every 16 steps, a motion never.
void looks(const gpu_step::Rve& rve, std::size_t count) {
  constexpr int held = 160, looked = held / 16;
  RveBatch batch = copies(rve, count);
  for (const Precision precision : precisions) {
    const Timed moved = timed(batch, precision, 0, 10 + held, 1), hold = timed(batch, precision, 0, 10, held);
    const double look = (hold.kernel - moved.kernel) / looked;
    std::printf("%5d grains %5zu RVEs %-6s: a look takes %.3f ms, %.1f steps\n", rve.grains(), count,
                name_of(precision), 1e3 * look, look / (moved.kernel / (11 + held)));
  }
}

struct Run {
  std::vector<RveReport> reports;
  RveBatch batch;
};

Run run(const gpu_step::Rve& rve, std::size_t count, EngineSettings settings) {
  Run r{std::vector<RveReport>(count), copies(rve, count)};
  const auto asked = requests(count, 200, 400);
  advance(r.batch, std::span<const StrainRequest>(asked), settings, r.reports);
  return r;
}

bool same_bits(const Run& a, const Run& b, std::size_t v) {
  const RveReport &x = a.reports[v], &y = b.reports[v];
  bool same = x.status == y.status && x.steps == y.steps && x.contacts == y.contacts && x.unbalanced == y.unbalanced &&
              std::equal(std::begin(x.stress), std::end(x.stress), std::begin(y.stress));
  const RveStates &t = a.batch.trial, &u = b.batch.trial;
  for (std::size_t i = 0; i < t.position.extent(1); ++i) {
    same = same && t.position(v, i, 0) == u.position(v, i, 0) && t.position(v, i, 1) == u.position(v, i, 1) &&
           t.rotation(v, i) == u.rotation(v, i);
  }
  same = same && t.contact_count(v) == u.contact_count(v);
  for (int c = 0; same && c < t.contact_count(v); ++c) {
    same = t.contact_key(v, c) == u.contact_key(v, c) && t.contact_history(v, c, 0) == u.contact_history(v, c, 0) &&
           t.contact_history(v, c, 1) == u.contact_history(v, c, 1);
  }
  return same;
}

void compare(const char* with, const Run& a, const Run& b) {
  std::size_t same = 0;
  double off = 0;  // of the stress, over the pressure
  for (std::size_t v = 0; v < a.reports.size(); ++v) {
    same += same_bits(a, b, v) ? 1 : 0;
    for (int c = 0; c < 4; ++c) {
      off = std::max(off, std::abs(a.reports[v].stress[c] - b.reports[v].stress[c]) / b.reports[v].pressure());
    }
  }
  std::printf("  against %-22s: all bits in %zu of %zu RVEs, stress off by %.1e of p\n", with, same, a.reports.size(),
              off);
  std::fflush(stdout);
}

void check(const gpu_step::Rve& rve, std::size_t count) {
  constexpr double tolerance = 1e-3;
  for (const Precision precision : precisions) {
    EngineSettings settings = team_settings(precision, 0, tolerance);
    const Run teams = run(rve, count, settings);
    std::printf("%d grains, %s, teams as Kokkos chooses:\n", rve.grains(), name_of(precision));
    compare("a second run", teams, run(rve, count, settings));
    settings.backend = Backend::lanes;
    compare("lanes", teams, run(rve, count, settings));
    settings.backend = Backend::teams;
    settings.team_size = 256;
    compare("teams of 256 threads", teams, run(rve, count, settings));
  }
}

int measure(int argc, char** argv) {
  if (argc < 4) throw std::runtime_error("usage: team_rates rates|looks|check|once PACKING RVES...");
  const std::string what = argv[1];
  const gpu_step::Rve rve = gpu_step::read_packing(argv[2]);
  if (what == "once") {
    if (argc < 7) throw std::runtime_error("once PACKING RVES STEPS THREADS float|double");
    RveBatch batch = copies(rve, std::stoul(argv[3]));
    const auto asked = requests(batch.size(), std::stoi(argv[4]), 1);
    std::vector<RveReport> reports(batch.size());
    const Precision precision = std::string(argv[6]) == "float" ? Precision::float32 : Precision::float64;
    advance(batch, std::span<const StrainRequest>(asked), team_settings(precision, std::stoi(argv[5]), never), reports);
    return 0;
  }
  for (int k = 3; k < argc; ++k) {
    const std::size_t count = std::stoul(argv[k]);
    if (what == "rates") rates(rve, count);
    if (what == "looks") looks(rve, count);
    if (what == "check") check(rve, count);
  }
  return 0;
}

}  // namespace
}  // namespace voussoir::kernels

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  Kokkos::Tools::Experimental::set_begin_parallel_for_callback(voussoir::kernels::begin_kernel);
  Kokkos::Tools::Experimental::set_end_parallel_for_callback(voussoir::kernels::end_kernel);
  try {
    return voussoir::kernels::measure(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "team_rates: %s\n", e.what());
    return 1;
  }
}
