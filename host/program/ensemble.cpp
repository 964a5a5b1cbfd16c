// The command `voussoir ensemble`: one case with many draws of its packings. Each member is a process of its own.
#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "host/case/load_case.hpp"
#include "host/ensemble/csv.hpp"
#include "host/ensemble/reduction.hpp"
#include "host/packing/packings.hpp"
#include "host/process/interrupt.hpp"
#include "host/process/standard_streams.hpp"
#include "host/program/accept_case.hpp"
#include "host/program/commands.hpp"
#include "host/program/ensemble_goal.hpp"
#include "host/program/run_processes.hpp"
#include "host/program/run_summary.hpp"
#include "host/program/sweep_outcome.hpp"
#include "host/ranks/session.hpp"
#include "host/record/provenance.hpp"
#include "io/atomic_file.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

constexpr int most_unless_said = 64;  ///< members of `--until`
constexpr int first_members = 4;      ///< with which `--until` begins: fewer say little about a standard error

struct Ensemble {
  fs::path case_file;
  Case input;
  EnsembleOptions options;
  std::optional<Goal> goal;
  int most = 0;  ///< members at the most
  std::vector<ProcessRun> runs;
  std::vector<bool> reduced;            ///< (run) its results are among `finished`
  std::vector<MemberResults> finished;  ///< in the order of the runs
};

/// The seed of a member: members draw seeds that no other member draws.
std::int64_t seed_of(const Case& input, std::size_t member) {
  return input.packing.seed + static_cast<std::int64_t>(member * count_of_packings(input.packing));
}

/// Throws where all members of the case would be the same run.
void expect_a_draw(const Case& input) {
  const auto refuse = [&](const char* key, const std::string& sentence) {
    throw io::InputError(place_of(input, key), key, sentence);
  };
  if (!runs_on_a_mesh(input.kind)) {
    refuse("kind", fmt::format("is {}: an ensemble needs a kind with a mesh, which draws its packings by packing.seed: "
                               "biaxial_bvp, column or tunnel",
                               to_string(input.kind)));
  }
  if (input.material != MaterialKind::grains)
    refuse("material", fmt::format("is {}: without grains all members would be the same", to_string(input.material)));
  if (!input.packing.files.empty())
    refuse("packing.file", "names the packings: all members of an ensemble would be the same");
  if (!input.packing.seeds.empty()) {
    refuse("packing.seeds",
           "names the seeds: all members of an ensemble would be the same; packing.seed and packing.candidates leave "
           "them to draw");
  }
}

ProcessRun member_run(const Ensemble& ensemble, std::size_t member) {
  ProcessRun run{.name = fmt::format("member_{:03}", member), .overrides = ensemble.options.overrides, .folder = {}};
  run.overrides.push_back(fmt::format("packing.seed={}", seed_of(ensemble.input, member)));
  run.folder = ensemble.options.folder / run.name;
  return run;
}

/// Validates the case of every member and looks at its folder, before anything is written.
Ensemble prepare(const fs::path& case_file, const EnsembleOptions& given) {
  if (rank_count() > 1) throw io::InputError("ensemble", "", "starts processes of its own: run it without mpirun");
  if (!given.members && given.until.empty())
    throw io::InputError("ensemble", "", "needs the number of members (-n) or the wanted accuracy (--until)");
  Ensemble ensemble{.case_file = case_file,
                    .input = accept_case(case_file, given.overrides).input,
                    .options = given,
                    .goal = {},
                    .most = given.members.value_or(most_unless_said),
                    .runs = {},
                    .reduced = {},
                    .finished = {}};
  expect_a_draw(ensemble.input);
  ensemble.goal = goal_of(ensemble.input, given.until, given.result);
  fs::path& folder = ensemble.options.folder;
  if (folder.empty()) folder = fs::path("out") / (ensemble.input.name + "_ensemble");
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw io::InputError("--output", folder.string(), "is not a folder");
  if (fs::exists(folder / "run.h5"))
    throw io::InputError("--output", folder.string(), "holds the results of a run: choose another folder");
  for (std::size_t k = 0; k < static_cast<std::size_t>(ensemble.most); ++k) {
    const ProcessRun run = member_run(ensemble, k);
    const Case member = load_case(case_file, run.overrides);
    expect_unlocked(run.folder);
    check_folder({.folder = run.folder, .resume = given.runs.resume, .command = {}}, identity_of(member));
  }
  return ensemble;
}

/// True where a run has results up to the planned end. A run that ends without equilibrium may have gone on beyond
/// increments that did not converge: leaving it out would choose the members by their answers.
bool has_all_increments(const ProcessRun& run, const Case& input) {
  if (run.end.outcome == Outcome::done) return true;
  const fs::path index = run.folder / "run.h5";
  return run.end.outcome == Outcome::no_equilibrium && fs::exists(index) &&
         is_at_end(input, io::read_increments(index));
}

/// Runs further members up to this number; returns how many of them came to their end.
std::size_t run_members(Ensemble& ensemble, std::size_t up_to) {
  const std::size_t before = ensemble.runs.size();
  while (ensemble.runs.size() < up_to) ensemble.runs.push_back(member_run(ensemble, ensemble.runs.size()));
  const auto added = std::span(ensemble.runs).subspan(before);
  run_processes(added, ensemble.case_file, ensemble.options.runs);
  write_summary(ensemble.runs, ensemble.options.folder / "summary.csv");  // before anything can fail
  const std::size_t finished_before = ensemble.finished.size();
  for (const ProcessRun& run : added) {
    ensemble.reduced.push_back(!interrupted() && has_all_increments(run, ensemble.input));
    if (ensemble.reduced.back()) ensemble.finished.push_back(read_member(run.folder));
  }
  return ensemble.finished.size() - finished_before;
}

/// Runs all members, or adds members until the goal is reached. Returns the standard error that was reached.
std::optional<double> run_all(Ensemble& ensemble) {
  const auto most = static_cast<std::size_t>(ensemble.most);
  if (!ensemble.goal) {
    run_members(ensemble, most);
    return std::nullopt;
  }
  const std::size_t least = std::min<std::size_t>(first_members, most);
  std::optional<double> error;
  for (std::size_t up_to = least;;) {
    const std::size_t finished = run_members(ensemble, up_to);
    if (interrupted()) return error;
    if (ensemble.finished.size() >= 2) {
      error = relative_error(ensemble.finished, ensemble.goal->result);
      std::printf("%zu members: the standard error of %s is %.3g %% of its mean, wanted %.3g %%\n",
                  ensemble.finished.size(), ensemble.goal->result.c_str(), 100 * *error, 100 * ensemble.goal->share);
    }
    static_cast<void>(lost_output());
    const bool reached = error && *error <= ensemble.goal->share && ensemble.finished.size() >= least;
    // Where no member of a round comes to its end, further ones would hardly do.
    if (reached || up_to == most || finished == 0) return error;
    up_to = std::min(most, up_to + static_cast<std::size_t>(ensemble.options.runs.processes));
  }
}

std::vector<io::EnsembleMember> members_of(const Ensemble& ensemble) {
  std::vector<io::EnsembleMember> members;
  for (std::size_t k = 0; k < ensemble.runs.size(); ++k) {
    const ProcessRun& run = ensemble.runs[k];
    members.push_back({run.name, seed_of(ensemble.input, k), name_of(run.end), run.end.code, ensemble.reduced[k]});
  }
  return members;
}

/// Names the members that did not end well: those with results up to the end, and those without.
void name_failed(const Ensemble& ensemble, bool reduced) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < ensemble.runs.size(); ++k) {
    const ProcessRun& run = ensemble.runs[k];
    if (run.end.outcome == Outcome::done || ensemble.reduced[k] != reduced) continue;
    names.push_back(fmt::format("{} ({})", run.name, name_of(run.end)));
  }
  if (names.empty()) return;
  const bool one = names.size() == 1;
  const std::string what = reduced ? fmt::format("{} increments that did not converge and {} part of",
                                                 one ? "has" : "have", one ? "is" : "are")
                                   : fmt::format("{} no results up to the end and {} no part of", one ? "has" : "have",
                                                 one ? "is" : "are");
  std::fprintf(stderr, "voussoir: %zu of %zu members %s the means and bands: %s\n", names.size(), ensemble.runs.size(),
               what.c_str(), fmt::format("{}", fmt::join(names, ", ")).c_str());
}

/// Says whether the folder still belongs to this process, as a run does before each write.
void confirm(const RunLock& lock) {
  const std::string changed = lock.confirm();
  if (!changed.empty()) std::fprintf(stderr, "voussoir: %s\n", changed.c_str());
}

/// A reduction that is killed leaves no ensemble.h5, rather than one whose fields are of other members.
void remove_earlier_reduction(const fs::path& folder) {
  for (const char* name : {"ensemble.h5", "curves.csv", "members.csv"}) fs::remove(folder / name);
  fs::remove_all(folder / "fields");
}

io::Provenance provenance_of(const Ensemble& ensemble) {
  RunOptions options{.folder = ensemble.options.folder, .command = ensemble.options.command};
  options.threads = io::read_provenance(ensemble.finished.front().folder / "run.h5").threads;
  return provenance_of(options, ensemble.input, to_string(ensemble.input.kind));
}

/// Writes the means and bands. Returns false where a request to stop ended the reduction.
bool reduce(const Ensemble& ensemble, std::optional<double> error, const RunLock& lock) {
  const fs::path& folder = ensemble.options.folder;
  const BandRule rule = band_rule(static_cast<int>(ensemble.finished.size()));
  io::EnsembleData data;
  data.provenance = provenance_of(ensemble);
  data.members = members_of(ensemble);
  data.seeds_of_a_member = static_cast<int>(count_of_packings(ensemble.input.packing));
  if (ensemble.goal) data.goal = {ensemble.goal->result, ensemble.goal->share, error.value_or(0)};
  reduce_curves(ensemble.finished, rule, data);
  const auto most = std::max_element(
      ensemble.finished.begin(), ensemble.finished.end(),
      [](const MemberResults& a, const MemberResults& b) { return a.increments.size() < b.increments.size(); });
  if (most->increments.size() > data.increments.size()) {
    std::fprintf(stderr, "voussoir: %zu increments of %s are left out, because another member lacks them\n",
                 most->increments.size() - data.increments.size(), most->folder.c_str());
  }
  fs::create_directories(folder / "fields");
  const bool whole = reduce_fields(ensemble.finished, rule, data.increments, folder, [&lock] {
    confirm(lock);
    return !interrupted();
  });
  if (!whole) return false;
  io::write_text(folder / "curves.csv", curves_csv(data));
  io::write_text(folder / "members.csv", members_csv(data.members, ensemble.finished));
  io::write_ensemble(folder, data);
  std::printf("means and bands of %d members: %s\n", rule.members, (folder / "ensemble.h5").c_str());
  return true;
}

/// The outcome of an ensemble whose members are all done but for the goal of --until.
Outcome judge(const Goal& goal, const Ensemble& ensemble, double error) {
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
  const fs::path folder = ensemble.options.folder;
  catch_interrupts();
  const RunLock lock(folder, given.runs.take_over);
  io::remove_leftovers(folder);
  if (!lock.note().empty()) std::printf("%s\n", lock.note().c_str());
  const std::size_t stride = count_of_packings(ensemble.input.packing);
  std::printf("the members draw %zu %s each, from seed %lld on\n", stride, stride == 1 ? "seed" : "seeds",
              static_cast<long long>(ensemble.input.packing.seed));
  ensemble.options.runs.threads = threads_of_a_run(ensemble.options.runs);
  const std::optional<double> error = run_all(ensemble);
  confirm(lock);
  std::vector<RunEnd> ends;
  for (const ProcessRun& run : ensemble.runs) ends.push_back(run.end);
  Outcome outcome = outcome_of(ends);
  if (interrupted() || outcome == Outcome::interrupted) return Outcome::interrupted;
  name_failed(ensemble, true);
  name_failed(ensemble, false);
  remove_earlier_reduction(folder);
  if (ensemble.finished.size() < 2) {
    io::write_text(folder / "members.csv", members_csv(members_of(ensemble), ensemble.finished));
    std::fprintf(stderr, "voussoir: means and bands need two members with results up to the end, and there %s\n",
                 ensemble.finished.empty() ? "is none" : "is one");
    return outcome;
  }
  if (!reduce(ensemble, error, lock)) return Outcome::interrupted;
  if (ensemble.goal && error) {
    const Outcome judged = judge(*ensemble.goal, ensemble, *error);
    if (outcome == Outcome::done) outcome = judged;
  }
  static_cast<void>(lost_output());
  return outcome;
}

}  // namespace voussoir::host
