#pragma once
/// The team kernel and its launch. Only advance_teams.cpp and tests include this file, because it takes long to
/// compile.

#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "kernels/course/flush_subnormals.hpp"
#include "kernels/teams/team_finish.hpp"

namespace voussoir::kernels::teams {

/// Judges a measuring step; one thread calls it.
template <class Run>
KOKKOS_FUNCTION void judge_team(const Run& run, int step) {
  auto& course = run.course();
  Measurement seen;
  const Outcome outcome = judge(course, step, run.settings, run.shared().sums, 0, run.shared().cell, run.scales(),
                                seen);
  course.running = outcome == Outcome::running;
  if constexpr (std::is_same_v<typename Run::Drive, ServoControl>) {
    if (outcome == Outcome::lost || !course.drive.samples(step)) return;
    const int at = run.batch.sample_count(run.rve)++;
    run.batch.samples(run.rve, at) = course.drive.sample(step, seen);
  }
}

template <Sweep mode, class Run>
KOKKOS_FUNCTION void sweep_team(const Run& run) {
  press_pairs<mode>(run);
  move_grains<mode>(run);
}

/// Brings the team's RVE from its committed to its trial state.
template <class Run>
KOKKOS_FUNCTION void advance_team(const Run& run) {
  restore(run);
  for (int step = 0; run.course().running; ++step) {
    alone(run, [&] { move_cell(run.course(), step, run.shared().motion, 0); });
    if (step >= run.course().next_list_check) check_list(run, step);
    if (!run.course().running) break;
    if (guards(run.settings, step) || run.course().drive.looks(step)) {
      sweep_team<Sweep::measure>(run);
      sum_step(run);
      alone(run, [&] { judge_team(run, step); });
    } else {
      sweep_team<Sweep::advance>(run);
    }
  }
  finish(run);
}

template <class Law, class Drive, class Space>
struct AdvanceTeams {
  using ContactLaw = Law;
  using V = typename Law::Value;
  using Policy = Kokkos::TeamPolicy<Space, Kokkos::Schedule<Kokkos::Dynamic>>;
  using Member = typename Policy::member_type;

  TeamBatch<real_of<V>, Drive, Space> batch;
  EngineSettings settings;
  int hot_level = 0;

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const FlushSubnormals flush;
    const TeamRun<Law, Drive, Space, Member> run(member, batch, settings, hot_level);
    advance_team(run);
  }
};

/// Asks for the kernel's scratch: fast memory for the numbers that every step reads, if they fit, and the level below
/// for all else.
/// @throws std::invalid_argument where a level is too small
template <class Kernel>
void ask_for_scratch(typename Kernel::Policy& policy, Kernel& kernel) {
  using Scratch = TeamScratch<typename Kernel::ContactLaw, typename decltype(kernel.batch.drives)::value_type,
                              typename Kernel::Policy::execution_space>;
  const int grains = kernel.batch.most_grains;
  const std::size_t hot = Scratch::hot_bytes(grains), cold = Scratch::cold_bytes(grains);
  const bool fits = hot <= static_cast<std::size_t>(Kernel::Policy::scratch_size_max(0));
  kernel.hot_level = fits ? 0 : 1;
  const std::size_t below = fits ? cold : hot + cold;
  if (below > static_cast<std::size_t>(Kernel::Policy::scratch_size_max(1))) {
    throw std::invalid_argument("teams: a packing's list does not fit a team's scratch");
  }
  if (fits) policy.set_scratch_size(0, Kokkos::PerTeam(static_cast<int>(hot)));
  policy.set_scratch_size(1, Kokkos::PerTeam(static_cast<int>(below)));
}

template <class Kernel>
[[nodiscard]] typename Kernel::Policy team_policy(int league, int team_size, const Kernel& kernel) {
  using Policy = typename Kernel::Policy;
  if (team_size == 0) return Policy(league, Kokkos::AUTO);
  if (team_size > Policy(league, 1).team_size_max(kernel, Kokkos::ParallelForTag())) {
    throw std::invalid_argument("teams: the execution space forms no teams of that size");
  }
  return Policy(league, team_size);
}

/// Makes room for the traces that requests ask for.
template <class Batch>
void make_sample_room(Batch& batch, std::span<const ServoRequest> requests) {
  int room = 0;
  for (const ServoRequest& r : requests) {
    if (r.microstructure.any()) throw std::invalid_argument("teams: no microstructure is recorded along a path");
    if (r.trace != nullptr) room = std::max(room, (r.max_steps - 1) / r.trace_interval + 1);
  }
  batch.samples = decltype(batch.samples)("voussoir::team_launch::samples", requests.size(),
                                          static_cast<std::size_t>(room));
  batch.sample_count = decltype(batch.sample_count)("voussoir::team_launch::sample_count", requests.size());
}
template <class Batch>
void make_sample_room(Batch&, std::span<const StrainRequest>) {}

template <class Batch>
void append_samples(const Batch& batch, std::span<const ServoRequest> requests) {
  const auto samples = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), batch.samples);
  const auto counts = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), batch.sample_count);
  for (std::size_t k = 0; k < requests.size(); ++k) {
    for (int c = 0; c < counts(k); ++c) requests[k].trace->push_back(samples(k, c));
  }
}
template <class Batch>
void append_samples(const Batch&, std::span<const StrainRequest>) {}

template <class Space, class Law, class Drive>
[[nodiscard]] TeamBatch<real_of<typename Law::Value>, Drive, Space> team_batch(
    const RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
    std::span<const RveReport> reports, std::span<const int> rves) {
  const auto steps = [&](int rve) {
    const auto k = static_cast<std::size_t>(rve);
    return predicted_steps(requests[k], reports[k].steps);
  };
  std::vector<int> order(rves.begin(), rves.end());
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return steps(a) > steps(b); });
  std::vector<Drive> drives;
  std::vector<RunScales> scales;
  for (const Packing& packing : batch.packings) scales.push_back(scales_of<Law>(packing, settings));
  for (std::size_t k = 0; k < batch.size(); ++k) {
    drives.emplace_back(requests[k], scales[static_cast<std::size_t>(batch.packing_of[k])], settings);
  }
  TeamBatch<real_of<typename Law::Value>, Drive, Space> out{
      .packings = team_packings<Law, Space>(batch, settings),
      .committed = team_states<Space>(batch.committed),
      .trial = team_states<Space>(batch.trial),
      .packing_of = team_array<Space>("voussoir::team_launch::packing_of", std::span<const int>(batch.packing_of)),
      .order = team_array<Space>("voussoir::team_launch::order", std::span<const int>(order)),
      .drives = team_array<Space>("voussoir::team_launch::drives", std::span<const Drive>(drives)),
      .reports = TeamArray<RveReport*, Space>("voussoir::team_launch::reports", batch.size()),
      .samples = {},
      .sample_count = {}};
  out.most_grains = static_cast<int>(out.packings.radii.extent(1));
  make_sample_room(out, requests);
  return out;
}

template <class Law, class Drive, class Space>
Work launch_teams(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
                  std::span<RveReport> reports, std::span<const int> rves) {
  using Kernel = AdvanceTeams<Law, Drive, Space>;
  if (settings.tangent != TangentKind::contact) throw std::invalid_argument("teams: the only tangent is eq. (4)");
  if (batch.committed.history_size() != static_cast<std::size_t>(history_size<Law>)) {
    throw std::invalid_argument("teams: the batch holds the histories of another law");
  }
  if (rves.empty()) return {};
  const Kokkos::Profiling::ScopedRegion region("voussoir::teams");
  Kernel kernel{.batch = team_batch<Space, Law, Drive>(batch, requests, settings, reports, rves), .settings = settings};
  auto policy = team_policy(static_cast<int>(rves.size()), settings.team_size, kernel);
  policy.set_chunk_size(1);
  ask_for_scratch(policy, kernel);
  Kokkos::parallel_for("voussoir::team_launch::advance", policy, kernel);
  const auto answers = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), kernel.batch.reports);
  copy_back(kernel.batch.trial, batch.trial);
  append_samples(kernel.batch, requests);
  Work work;
  for (const int rve : rves) {
    const auto k = static_cast<std::size_t>(rve);
    reports[k] = answers(k);
    work.particle_steps += static_cast<std::size_t>(batch.packing(k).size()) *
                           static_cast<std::size_t>(reports[k].steps);
  }
  work.lane_steps = work.particle_steps;  // a team ends with its RVE
  return work;
}

}  // namespace voussoir::kernels::teams
