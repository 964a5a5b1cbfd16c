#include "host/program/sweep_gather.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <utility>
#include <vector>

#include "host/case/load_case.hpp"
#include "host/process/interrupt.hpp"
#include "host/process/standard_streams.hpp"
#include "host/program/ensemble_members.hpp"
#include "host/program/run_rows.hpp"
#include "host/program/sweep_outcome.hpp"
#include "io/atomic_file.hpp"
#include "io/outcome_file.hpp"
#include "io/result_file.hpp"
#include "io/text_file.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_reason_bytes = 2000;  // it names files and folders, whose lengths differ from place to place

/// A run of the plan with the end that was kept of it.
ProcessRun ended_run(const PlannedRun& planned, const fs::path& folder) {
  ProcessRun run{.name = planned.name,
                 .case_file = planned.case_file,
                 .overrides = planned.overrides,
                 .folder = folder / planned.name};
  if (const auto kept = io::read_outcome(outcome_path(folder, planned.name))) {
    run.end = end_of_code(kept->exit_code);
    run.reason = io::in_one_line(kept->reason, most_reason_bytes);
  }
  return run;
}

/// Compares what lies in a run's folder with its case, which may have changed since. Results of another case make the
/// run one with wrong input; a run that is done and has no results is a machine failure.
void check_results(ProcessRun& run, const Case& input) {
  const fs::path index = run.folder / "run.h5";
  const auto fail = [&run](Outcome outcome, const char* reason) {
    run.end = end_of_code(exit_code(outcome));
    run.reason = reason;
  };
  if (!fs::exists(index)) {
    if (run.end.outcome == Outcome::done && runs_on_a_mesh(input.kind))
      fail(Outcome::machine_failure, "it was done, and its run.h5 is missing; --resume runs it again");
    return;
  }
  try {
    if (io::read_provenance(index).fingerprint == input.fingerprint) return;
  } catch (const std::exception&) {
    return;  // read_run tells of the damage
  }
  fail(Outcome::wrong_input, "its folder holds results of another case than the sweep file now asks for");
}

/// Where the files of the run are not what its end promises, the end changes, see check_results and read_run.
ReadRun read_planned(const PlannedRun& planned, ProcessRun& run) {
  const Case input = load_case(planned.case_file, planned.overrides);
  check_results(run, input);
  ReadRun read = read_run(run);
  io::SweepRow& row = read.row;
  row.kind = to_string(input.kind);
  row.grid = planned.grid;
  row.point = planned.point;
  row.axes = {planned.axes.begin(), planned.axes.end()};
  return read;
}

/// The runs of a sweep in the order of its plan, with what was read of them.
struct GatheredRuns {
  std::vector<ProcessRun> runs;
  std::vector<ReadRun> read;
};

/// Reduces the members of one point, whose results leave `gathered`; the sweep's lock covers the folder of the point.
/// Returns whether an ensemble.h5 came of it.
bool reduce_point(const PlannedEnsemble& planned, GatheredRuns& gathered, const fs::path& folder, const RunLock& lock,
                  const std::string& command) {
  EnsembleMembers members{.input = load_case(planned.case_file, planned.overrides),
                          .folder = folder / planned.name,
                          .command = command,
                          .point = planned.name};
  for (std::size_t member = 0; member < planned.runs.size(); ++member) {
    ProcessRun run = gathered.runs[planned.runs[member]];
    ReadRun read = std::move(gathered.read[planned.runs[member]]);
    run.name = read.row.name = run.folder.filename().string();
    read.row.axes.clear();  // the members of a point have the same place on every axis
    if (run.end.outcome && run.end.outcome != Outcome::interrupted)
      add_member(members, std::move(run), member, std::move(read));
  }
  if (members.runs.empty()) return false;
  fs::create_directories(members.folder);  // a member that could not start has not made it
  write_summary(members);
  static_cast<void>(reduce_members(members, std::nullopt, lock));
  return fs::exists(members.folder / "ensemble.h5");
}

/// One line for each run that did not end well, because a sweep of hundreds of runs hides it otherwise.
void name_failed(const std::vector<ProcessRun>& runs) {
  std::size_t failed = 0;
  for (const ProcessRun& run : runs) failed += run.end.outcome == Outcome::done ? 0 : 1;
  if (failed == 0) return;
  std::fprintf(stderr, "voussoir: %zu of %zu runs did not end well:\n", failed, runs.size());
  for (const ProcessRun& run : runs) {
    if (run.end.outcome == Outcome::done) continue;
    const std::string reason = run.reason.empty() ? "" : ": " + run.reason;
    std::fprintf(stderr, "voussoir:   %s (%s)%s\n", run.name.c_str(), name_of(run.end).c_str(), reason.c_str());
  }
}

}  // namespace

void keep_outcome(const fs::path& folder, const ProcessRun& run) {
  fs::create_directories(folder / "outcomes");
  io::write_outcome(outcome_path(folder, run.name), {name_of(run.end), run.end.code, run.reason});
}

Outcome gather(const SweepPlan& plan, const fs::path& folder, const RunLock& lock, const std::string& command) {
  GatheredRuns gathered;
  std::vector<RunEnd> ends;
  io::SweepData data{.input = plan.text, .runs = {}, .ensembles = {}};
  for (const PlannedRun& planned : plan.runs) {
    ProcessRun run = ended_run(planned, folder);
    ReadRun read = read_planned(planned, run);
    data.runs.push_back(read.row);
    ends.push_back(run.end);
    if (planned.point == planned.name) read.results.reset();  // no means are made of a run that is alone
    gathered.runs.push_back(std::move(run));
    gathered.read.push_back(std::move(read));
  }
  io::write_text(folder / "summary.csv", io::summary_csv(data.runs));
  bool reduced = true;
  for (const PlannedEnsemble& ensemble : plan.ensembles) {
    if (interrupted()) break;
    try {
      if (reduce_point(ensemble, gathered, folder, lock, command)) data.ensembles.push_back(ensemble.name);
    } catch (const std::exception& failure) {  // the other points and the tables are written all the same
      std::fprintf(stderr, "voussoir: %s has no means: %s\n", ensemble.name.c_str(), failure.what());
      reduced = false;
    }
  }
  static_cast<void>(lock.confirm());  // it throws where another process has taken the folder over
  io::write_sweep(folder / "sweep.h5", data);
  std::printf("summary: %s\n", (folder / "summary.csv").c_str());
  static_cast<void>(lost_output());
  name_failed(gathered.runs);
  if (!reduced) ends.push_back(end_of_code(exit_code(Outcome::machine_failure)));
  return interrupted() ? Outcome::interrupted : outcome_of(ends);
}

}  // namespace voussoir::host
