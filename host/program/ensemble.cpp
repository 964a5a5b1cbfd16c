// The command `voussoir ensemble`: one case with many draws of its packings. Each member is a process of its own.
#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/case/load_case.hpp"
#include "host/ensemble/draws.hpp"
#include "host/ensemble/reduction.hpp"
#include "host/packing/packings.hpp"
#include "host/process/interrupt.hpp"
#include "host/process/standard_streams.hpp"
#include "host/program/accept_case.hpp"
#include "host/program/commands.hpp"
#include "host/program/ensemble_goal.hpp"
#include "host/program/ensemble_members.hpp"
#include "host/program/run_processes.hpp"
#include "host/program/run_rows.hpp"
#include "host/program/sweep_outcome.hpp"
#include "host/ranks/session.hpp"
#include "io/atomic_file.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

constexpr int most_unless_said = 64;  ///< members of `--until`
constexpr int first_members = 4;      ///< with which `--until` begins: fewer say little about a standard error

struct Ensemble {
  fs::path case_file;
  EnsembleOptions options;
  int most = 0;  ///< members at the most
  EnsembleMembers members;
};

/// Validates the case of every member and looks at its folder, before anything is written.
Ensemble prepare(const fs::path& case_file, const EnsembleOptions& given) {
  if (rank_count() > 1) throw io::InputError("ensemble", "", "starts processes of its own: run it without mpirun");
  if (!given.members && given.until.empty())
    throw io::InputError("ensemble", "", "needs the number of members (-n) or the wanted accuracy (--until)");
  Ensemble ensemble{
      .case_file = case_file,
      .options = given,
      .most = given.members.value_or(most_unless_said),
      .members = {
          .input = accept_case(case_file, given.overrides).input, .folder = given.folder, .command = given.command}};
  EnsembleMembers& members = ensemble.members;
  expect_a_draw(members.input);
  members.goal = goal_of(members.input, given.until, given.result);
  fs::path& folder = members.folder;
  if (folder.empty()) folder = fs::path("out") / (members.input.name + "_ensemble");
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw io::InputError("--output", folder.string(), "is not a folder");
  if (fs::exists(folder / "run.h5"))
    throw io::InputError("--output", folder.string(), "holds the results of a run: choose another folder");
  for (std::size_t k = 0; k < static_cast<std::size_t>(ensemble.most); ++k) {
    const ProcessRun run = member_run(members, case_file, given.overrides, k);
    const Case member = load_case(case_file, run.overrides);
    expect_unlocked(run.folder);
    check_folder({.folder = run.folder, .resume = given.runs.resume, .command = {}}, identity_of(member));
  }
  return ensemble;
}

/// Runs further members up to this number; returns how many of them came to their end.
std::size_t run_members(Ensemble& ensemble, std::size_t up_to) {
  EnsembleMembers& members = ensemble.members;
  const std::size_t before = members.runs.size(), finished_before = members.finished.size();
  std::vector<ProcessRun> round;
  for (std::size_t k = before; k < up_to; ++k)
    round.push_back(member_run(members, ensemble.case_file, ensemble.options.overrides, k));
  run_processes(round, ensemble.options.runs);
  for (std::size_t k = 0; k < round.size(); ++k) {
    ReadRun read = read_run(round[k]);
    add_member(members, std::move(round[k]), before + k, std::move(read));
  }
  write_summary(members);
  return members.finished.size() - finished_before;
}

/// Runs all members, or adds members until the goal is reached. Returns the standard error that was reached.
std::optional<double> run_all(Ensemble& ensemble) {
  const auto most = static_cast<std::size_t>(ensemble.most);
  const EnsembleMembers& members = ensemble.members;
  if (!members.goal) {
    run_members(ensemble, most);
    return std::nullopt;
  }
  const Goal& goal = *members.goal;
  const std::size_t least = std::min<std::size_t>(first_members, most);
  std::optional<double> error;
  for (std::size_t up_to = least;;) {
    const std::size_t finished = run_members(ensemble, up_to);
    if (interrupted()) return error;
    if (members.finished.size() >= 2) {
      error = relative_error(members.finished, goal.result);
      std::printf("%zu members: the standard error of %s is %.3g %% of its mean, wanted %.3g %%\n",
                  members.finished.size(), goal.result.c_str(), 100 * *error, 100 * goal.share);
    }
    static_cast<void>(lost_output());
    const bool reached = error && *error <= goal.share && members.finished.size() >= least;
    // Where no member of a round comes to its end, further ones would hardly do.
    if (reached || up_to == most || finished == 0) return error;
    up_to = std::min(most, up_to + static_cast<std::size_t>(ensemble.options.runs.processes));
  }
}

/// The outcome of an ensemble whose members are all done but for the goal of --until.
Outcome judge(const Goal& goal, const EnsembleMembers& ensemble, double error) {
  if (error <= goal.share) {
    std::printf("it took %zu members: the standard error of %s is %.3g %% of its mean\n", ensemble.finished.size(),
                goal.result.c_str(), 100 * error);
    return Outcome::done;
  }
  std::fprintf(stderr,
               "voussoir: %zu members were not enough: the standard error of %s is %.3g %% of its mean, and --until "
               "asks for %.3g %%; a larger -n with --resume goes on\n",
               ensemble.finished.size(), goal.result.c_str(), 100 * error, 100 * goal.share);
  return Outcome::no_equilibrium;
}

}  // namespace

Outcome command_ensemble(const fs::path& case_file, const EnsembleOptions& given) {
  Ensemble ensemble = prepare(case_file, given);
  EnsembleMembers& members = ensemble.members;
  catch_interrupts();
  const RunLock lock(members.folder, given.runs.take_over);
  io::remove_leftovers(members.folder);
  if (!lock.note().empty()) std::printf("%s\n", lock.note().c_str());
  const std::size_t stride = count_of_packings(members.input.packing);
  std::printf("the members draw %zu %s each, from seed %lld on\n", stride, stride == 1 ? "seed" : "seeds",
              static_cast<long long>(members.input.packing.seed));
  ensemble.options.runs.threads = threads_of_a_run(ensemble.options.runs);
  const std::optional<double> error = run_all(ensemble);
  Outcome outcome = reduce_members(members, error, lock);
  if (outcome == Outcome::interrupted || members.finished.size() < 2) return outcome;
  if (members.goal && error) {
    const Outcome judged = judge(*members.goal, members, *error);
    if (outcome == Outcome::done) outcome = judged;
  }
  static_cast<void>(lost_output());
  return outcome;
}

}  // namespace voussoir::host
