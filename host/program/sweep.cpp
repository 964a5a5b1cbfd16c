// The command `voussoir sweep`. Each run is a process of its own, so that it behaves as it does without a sweep.
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "host/case/load_case.hpp"
#include "host/process/cores.hpp"
#include "host/process/interrupt.hpp"
#include "host/program/commands.hpp"
#include "host/program/sweep_outcome.hpp"
#include "host/ranks/session.hpp"
#include "io/atomic_file.hpp"
#include "io/case_file.hpp"
#include "io/input_error.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

struct SweepRun {
  std::string name;
  std::vector<std::string> overrides;
  std::filesystem::path folder;
  RunEnd end = {};
};

struct Sweep {
  std::filesystem::path base;
  std::vector<SweepRun> runs;
};

/// True where a name can be the name of a folder and, without quotes, a field of summary.csv.
bool is_plain(const std::string& name) {
  constexpr const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
  return !name.empty() && name.front() != '.' && name.find_first_not_of(allowed) == std::string::npos;
}

/// Reads the sweep and validates the case of every run, before anything is written.
Sweep load_sweep(const std::filesystem::path& file, const SweepOptions& options) {
  const io::CaseFile text = io::CaseFile::load(file);
  Sweep sweep;
  sweep.base = text.root().path("base");
  std::set<std::string> names;
  for (const io::Table& table : text.root().tables("run")) {
    SweepRun run{.name = table.text("name"), .overrides = table.texts("set", std::vector<std::string>{}), .folder = {}};
    if (!is_plain(run.name))
      throw table.error("name", "must consist of letters, digits and _ . - and must not begin with a dot");
    if (!names.insert(run.name).second) throw table.error("name", "is the name of two runs");
    run.folder = options.folder / run.name;
    expect_unlocked(run.folder);
    check_folder({.folder = run.folder, .resume = options.resume, .command = {}},
                 load_case(sweep.base, run.overrides).fingerprint);
    sweep.runs.push_back(std::move(run));
  }
  if (sweep.runs.empty()) throw text.root().error("run", "there is no [[run]] in this sweep");
  text.finish();
  return sweep;
}

pid_t start(const SweepRun& run, const std::filesystem::path& base, const SweepOptions& options) {
  std::vector<std::string> words{options.program.string(), "run", base.string(), "-o", run.folder.string()};
  for (const std::string& value : run.overrides) words.insert(words.end(), {"--set", value});
  if (options.threads > 0) words.insert(words.end(), {"--threads", std::to_string(options.threads)});
  if (options.resume) words.emplace_back("--resume");
  if (options.take_over) words.emplace_back("--take-over");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);  // the same lines are in run.log
  pid_t process = 0;
  const int failure = posix_spawn(&process, words.front().c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw std::system_error(failure, std::generic_category(), "cannot start " + words.front());
  return process;
}

/// Waits until one of the processes has ended and stores its exit code. A request to stop is passed on once, as
/// SIGUSR1: a terminal sends Ctrl-C to all processes, and a second SIGINT or SIGTERM would end a run at once.
void wait_for_one(std::map<pid_t, SweepRun*>& running, bool& passed_on) {
  int status = 0;
  pid_t process = 0;
  while ((process = waitpid(-1, &status, WNOHANG)) == 0) {
    if (interrupted() && !passed_on) {
      for (const auto& [child, run] : running) kill(child, SIGUSR1);
      passed_on = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (process < 0) throw std::system_error(errno, std::generic_category(), "cannot wait for a run");
  const auto found = running.find(process);
  if (found == running.end()) return;
  SweepRun& run = *found->second;
  run.end = end_of(status, passed_on);
  fmt::print("{}: {}\n", run.name, name_of(run.end));
  std::fflush(stdout);
  running.erase(found);
}

void run_all(Sweep& sweep, const SweepOptions& options) {
  std::map<pid_t, SweepRun*> running;
  bool passed_on = false;
  for (SweepRun& run : sweep.runs) {
    while (static_cast<int>(running.size()) >= options.processes) wait_for_one(running, passed_on);
    if (interrupted()) break;
    running.emplace(start(run, sweep.base, options), &run);
  }
  while (!running.empty()) wait_for_one(running, passed_on);
}

/// Writes one row for each run: how it ended, and the further columns of its last increment.
void write_summary(const Sweep& sweep, const std::filesystem::path& file) {
  std::vector<std::vector<io::IncrementInfo>> tables;
  std::set<std::string> columns;
  for (const SweepRun& run : sweep.runs) {
    const bool has_results = std::filesystem::exists(run.folder / "run.h5");
    tables.push_back(has_results ? io::read_increments(run.folder / "run.h5") : std::vector<io::IncrementInfo>{});
    if (tables.back().empty()) continue;
    for (const auto& [name, value] : tables.back().back().extra) columns.insert(name);
    columns.erase("volume_loss");  // this column repeats the load parameter of the stage "volume_loss"
  }
  std::string text = "name,status,exit_code,stage,load_parameter,iterations,particle_steps,wall_s";
  for (const std::string& column : columns) text += "," + column;
  text += "\n";
  for (std::size_t k = 0; k < sweep.runs.size(); ++k) {
    const SweepRun& run = sweep.runs[k];
    const io::IncrementInfo last = tables[k].empty() ? io::IncrementInfo{} : tables[k].back();
    int iterations = 0;
    double steps = 0;
    double wall = 0;
    for (const io::IncrementInfo& info : tables[k]) {
      iterations += info.iterations;
      steps += info.particle_steps;
      wall += info.wall_s;
    }
    text += fmt::format("{},{},{},{},{:.9g},{},{:.9g},{:.2f}", run.name, name_of(run.end), run.end.code, last.stage,
                        last.load_parameter, iterations, steps, wall);
    for (const std::string& column : columns) {
      text += last.extra.contains(column) ? fmt::format(",{:.9g}", last.extra.at(column).value) : ",";
    }
    text += "\n";
  }
  io::write_text(file, text);
}

/// The sweep's cores, shared among the runs at a time, where nobody has said a number.
int threads_of_a_run(const SweepOptions& options) {
  const bool said = options.threads > 0 || getenv("OMP_NUM_THREADS") != nullptr ||
                    getenv("KOKKOS_NUM_THREADS") != nullptr;
  if (said || options.processes == 1) return options.threads;
  return std::max(1, cores_of_this_process().usable() / options.processes);
}

}  // namespace

Outcome command_sweep(const std::filesystem::path& sweep_file, const SweepOptions& given) {
  if (rank_count() > 1) throw io::InputError("sweep", "", "starts processes of its own: run it without mpirun");
  SweepOptions options = given;
  if (options.folder.empty()) options.folder = std::filesystem::path("out") / sweep_file.stem();
  Sweep sweep = load_sweep(sweep_file, options);
  catch_interrupts();
  const RunLock lock(options.folder, options.take_over);
  if (!lock.note().empty()) fmt::print("{}\n", lock.note());
  options.threads = threads_of_a_run(options);
  run_all(sweep, options);
  write_summary(sweep, options.folder / "summary.csv");
  fmt::print("summary: {}\n", (options.folder / "summary.csv").string());
  std::vector<RunEnd> ends;
  for (const SweepRun& run : sweep.runs) ends.push_back(run.end);
  return outcome_of(ends);
}

}  // namespace voussoir::host
