#include "host/program/sweep_gather.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>
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
    return;  // row_of tells of the damage
  }
  fail(Outcome::wrong_input, "its folder holds results of another case than the sweep file now asks for");
}

/// Where the files of the run are not what its end promises, the end changes, see check_results and row_of.
io::SweepRow planned_row(const PlannedRun& planned, ProcessRun& run) {
  const Case input = load_case(planned.case_file, planned.overrides);
  check_results(run, input);
  io::SweepRow row = row_of(run);
  row.kind = to_string(input.kind);
  row.grid = planned.grid;
  row.point = planned.point;
  row.axes = {planned.axes.begin(), planned.axes.end()};
  return row;
}

/// Reduces the members of one point; the sweep's lock covers its folder. Returns whether an ensemble.h5 came of it.
bool reduce_point(const PlannedEnsemble& planned, const std::vector<ProcessRun>& runs, const fs::path& folder,
                  const RunLock& lock, const std::string& command) {
  EnsembleMembers members{.input = load_case(planned.case_file, planned.overrides),
                          .folder = folder / planned.name,
                          .command = command,
                          .point = planned.name};
  for (std::size_t member = 0; member < planned.runs.size(); ++member) {
    ProcessRun run = runs[planned.runs[member]];
    run.name = run.folder.filename().string();
    if (run.end.outcome && run.end.outcome != Outcome::interrupted) add_member(members, std::move(run), member);
  }
  if (members.runs.empty()) return false;
  fs::create_directories(members.folder);  // a member that could not start has not made it
  collect(members, 0);
  write_summary(members.runs, members.folder / "summary.csv");
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
  std::vector<ProcessRun> runs;
  std::vector<RunEnd> ends;
  io::SweepData data{.input = plan.text, .runs = {}, .ensembles = {}};
  for (const PlannedRun& planned : plan.runs) {
    runs.push_back(ended_run(planned, folder));
    data.runs.push_back(planned_row(planned, runs.back()));
    ends.push_back(runs.back().end);
  }
  io::write_text(folder / "summary.csv", io::summary_csv(data.runs));
  bool reduced = true;
  for (const PlannedEnsemble& ensemble : plan.ensembles) {
    if (interrupted()) break;
    try {
      if (reduce_point(ensemble, runs, folder, lock, command)) data.ensembles.push_back(ensemble.name);
    } catch (const std::exception& failure) {  // the other points and the tables are written all the same
      std::fprintf(stderr, "voussoir: %s has no means: %s\n", ensemble.name.c_str(), failure.what());
      reduced = false;
    }
  }
  static_cast<void>(lock.confirm());  // it throws where another process has taken the folder over
  io::write_sweep(folder / "sweep.h5", data);
  std::printf("summary: %s\n", (folder / "summary.csv").c_str());
  static_cast<void>(lost_output());
  name_failed(runs);
  if (!reduced) ends.push_back(end_of_code(exit_code(Outcome::machine_failure)));
  return interrupted() ? Outcome::interrupted : outcome_of(ends);
}

}  // namespace voussoir::host
