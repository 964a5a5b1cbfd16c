// The command `voussoir sweep`. Each run is a process of its own, so that it behaves as it does without a sweep.
#include "host/sweep/sweep_file.hpp"

#include <cstdio>
#include <string>
#include <vector>

#include "host/process/interrupt.hpp"
#include "host/process/standard_streams.hpp"
#include "host/program/commands.hpp"
#include "host/program/run_processes.hpp"
#include "host/program/sweep_gather.hpp"
#include "host/program/sweep_list.hpp"
#include "host/program/sweep_outcome.hpp"
#include "host/ranks/session.hpp"
#include "io/atomic_file.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

ProcessRun process_run(const PlannedRun& planned, const fs::path& folder) {
  return {.name = planned.name,
          .case_file = planned.case_file,
          .overrides = planned.overrides,
          .folder = folder / planned.name};
}

/// Runs the processes and keeps how each ended in the sweep's folder.
void run_and_keep(std::span<ProcessRun> runs, const fs::path& folder, ProcessOptions options) {
  fs::create_directories(folder / "outcomes");
  options.complaints = [&folder](const ProcessRun& run) {
    return outcome_path(folder, run.name).replace_extension(".err");
  };
  options.on_end = [&folder](const ProcessRun& run) { keep_outcome(folder, run); };
  run_processes(runs, options);
}

/// Refuses a folder that is none, is that of a run, or is held by another sweep: its runs would refuse to start, and
/// how they ended before would be lost.
void expect_folder_of_sweeps(const fs::path& folder) {
  const auto refuse = [&folder](const char* sentence) { throw io::InputError("--output", folder.string(), sentence); };
  if (fs::exists(folder) && !fs::is_directory(folder)) refuse("is not a folder");
  if (fs::exists(folder / "run.h5")) refuse("holds the results of a run: choose another folder");
  expect_unlocked(folder);
}

/// Looks at the case and the folder of a run, before anything is written.
void expect_startable(const PlannedRun& planned, const ProcessRun& run, bool resume) {
  const Case input = accept_run(planned).input;
  expect_unlocked(run.folder);
  check_folder({.folder = run.folder, .resume = resume, .command = {}}, identity_of(input));
}

Outcome run_all(const SweepPlan& plan, const SweepOptions& given) {
  SweepOptions options = given;
  std::vector<ProcessRun> runs;
  for (const PlannedRun& planned : plan.runs) {
    runs.push_back(process_run(planned, options.folder));
    expect_startable(planned, runs.back(), options.runs.resume);
  }
  catch_interrupts();
  const RunLock lock(options.folder, options.runs.take_over);
  io::remove_leftovers(options.folder);
  if (fs::exists(options.folder / "outcomes")) io::remove_leftovers(options.folder / "outcomes");
  if (!lock.note().empty()) std::printf("%s\n", lock.note().c_str());
  options.runs.threads = threads_of_a_run(options.runs);
  run_and_keep(runs, options.folder, options.runs);
  const Outcome gathered = gather(plan, options.folder, lock, options.command);
  return interrupted() ? Outcome::interrupted : gathered;
}

/// Runs one run without the lock of the sweep's folder, so that others of its runs go on beside it.
Outcome run_one(const SweepPlan& plan, const SweepOptions& options) {
  const PlannedRun& planned = run_named(plan, options.only);
  ProcessRun run = process_run(planned, options.folder);
  expect_startable(planned, run, options.runs.resume);
  catch_interrupts();
  run_and_keep({&run, 1}, options.folder, options.runs);
  return outcome_of(std::vector<RunEnd>{run.end});
}

Outcome gather_only(const SweepPlan& plan, const SweepOptions& options) {
  catch_interrupts();
  const RunLock lock(options.folder, options.runs.take_over);
  return gather(plan, options.folder, lock, options.command);
}

}  // namespace

Outcome command_sweep(const fs::path& sweep_file, const SweepOptions& given) {
  if (rank_count() > 1) throw io::InputError("sweep", "", "starts processes of its own: run it without mpirun");
  SweepOptions options = given;
  if (options.folder.empty()) options.folder = fs::path("out") / sweep_file.stem();
  const SweepPlan plan = load_sweep(sweep_file);
  if (options.task == SweepTask::list) return print_answer(list_of(plan, options.folder, options.json));
  expect_folder_of_sweeps(options.folder);
  if (options.task == SweepTask::run_one) return run_one(plan, options);
  if (options.task == SweepTask::gather) return gather_only(plan, options);
  return run_all(plan, options);
}

}  // namespace voussoir::host
