// The command `voussoir sweep`. Each run is a process of its own, so that it behaves as it does without a sweep.
#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "host/process/interrupt.hpp"
#include "host/process/standard_streams.hpp"
#include "host/program/accept_case.hpp"
#include "host/program/commands.hpp"
#include "host/program/run_processes.hpp"
#include "host/program/run_summary.hpp"
#include "host/program/sweep_outcome.hpp"
#include "host/ranks/session.hpp"
#include "io/atomic_file.hpp"
#include "io/case_file.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

struct Sweep {
  std::filesystem::path base;
  std::vector<ProcessRun> runs;
};

constexpr const char* summary_name = "summary.csv";

/// Says why a name cannot be the name of a run's folder and, without quotes, a field of summary.csv.
std::string fault_of_name(const std::string& name) {
  constexpr const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
  constexpr std::size_t longest = 200;  // of 255 bytes that the name of a file may have, the rest is for endings
  if (name.empty() || name.front() == '.' || name.find_first_not_of(allowed) != std::string::npos)
    return "must consist of letters, digits and _ . - and must not begin with a dot";
  if (name.size() > longest) return fmt::format("must have at most {} letters, has {}", longest, name.size());
  if (name == summary_name || name == run_lock_name) return "is the name of a file that the sweep itself writes";
  return "";
}

/// The case of a run. A fault in it is told with the run's place in the sweep.
Case case_of(const io::Table& table, const Sweep& sweep, const ProcessRun& run) {
  try {
    return accept_case(sweep.base, run.overrides).input;
  } catch (const io::InputError& fault) {
    throw table.error("set", fmt::format("run {}: {}", run.name, fault.what()));
  }
}

/// Reads the sweep and validates the case of every run, before anything is written.
Sweep load_sweep(const std::filesystem::path& file, const SweepOptions& options) {
  const io::CaseFile text = io::CaseFile::load(file);
  Sweep sweep;
  sweep.base = text.root().path("base");
  std::set<std::string> names;
  for (const io::Table& table : text.root().tables("run")) {
    ProcessRun run{
        .name = table.text("name"), .overrides = table.texts("set", std::vector<std::string>{}), .folder = {}};
    if (const std::string fault = fault_of_name(run.name); !fault.empty()) throw table.error("name", fault);
    if (!names.insert(run.name).second) throw table.error("name", "is the name of two runs");
    run.folder = options.folder / run.name;
    const Case input = case_of(table, sweep, run);
    expect_unlocked(run.folder);
    check_folder({.folder = run.folder, .resume = options.runs.resume, .command = {}}, identity_of(input));
    sweep.runs.push_back(std::move(run));
  }
  if (sweep.runs.empty()) throw text.root().error("run", "there is no [[run]] in this sweep");
  text.finish();
  return sweep;
}

}  // namespace

Outcome command_sweep(const std::filesystem::path& sweep_file, const SweepOptions& given) {
  if (rank_count() > 1) throw io::InputError("sweep", "", "starts processes of its own: run it without mpirun");
  SweepOptions options = given;
  if (options.folder.empty()) options.folder = std::filesystem::path("out") / sweep_file.stem();
  Sweep sweep = load_sweep(sweep_file, options);
  catch_interrupts();
  const RunLock lock(options.folder, options.runs.take_over);
  io::remove_leftovers(options.folder);
  if (!lock.note().empty()) std::printf("%s\n", lock.note().c_str());
  options.runs.threads = threads_of_a_run(options.runs);
  run_processes(sweep.runs, sweep.base, options.runs);
  write_summary(sweep.runs, options.folder / summary_name);
  std::printf("summary: %s\n", (options.folder / summary_name).c_str());
  static_cast<void>(lost_output());
  std::vector<RunEnd> ends;
  for (const ProcessRun& run : sweep.runs) ends.push_back(run.end);
  return outcome_of(ends);
}

}  // namespace voussoir::host
