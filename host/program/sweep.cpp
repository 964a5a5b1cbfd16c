// The command `voussoir sweep`. Each run is a process of its own, so that it behaves as it does without a sweep.
#include <fcntl.h>
#include <signal.h>
#include <spdlog/fmt/fmt.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "host/process/cores.hpp"
#include "host/process/interrupt.hpp"
#include "host/process/standard_streams.hpp"
#include "host/program/accept_case.hpp"
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
    const Case input = accept_case(sweep.base, run.overrides).input;
    expect_unlocked(run.folder);
    check_folder({.folder = run.folder, .resume = options.resume, .command = {}}, identity_of(input));
    sweep.runs.push_back(std::move(run));
  }
  if (sweep.runs.empty()) throw text.root().error("run", "there is no [[run]] in this sweep");
  text.finish();
  return sweep;
}

/// The forked child's way to its program; it calls only what is allowed between fork and exec. If the sweep dies, the
/// child gets SIGTERM, so that no run goes on that nobody waits for: a run on a mesh then ends after its increment, and
/// `sweep --resume` goes on with it.
[[noreturn]] void become(const std::vector<char*>& arguments, pid_t sweep, const sigset_t& signals) {
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) ::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  ::sigprocmask(SIG_SETMASK, &signals, nullptr);
  if (::getppid() != sweep)
    ::_exit(exit_code(Outcome::interrupted));         // the sweep died before the child could ask to be told
  const int nowhere = ::open("/dev/null", O_WRONLY);  // the same lines are in run.log
  if (nowhere >= 0) ::dup2(nowhere, STDOUT_FILENO);
  ::execv(arguments.front(), arguments.data());
  constexpr std::string_view complaint = "voussoir: the program of a run cannot be started\n";
  static_cast<void>(!::write(STDERR_FILENO, complaint.data(), complaint.size()));
  ::_exit(exit_code(Outcome::machine_failure));
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

  // A signal that came between fork and exec would be lost in a copy of this process.
  sigset_t all, before;
  sigfillset(&all);
  ::sigprocmask(SIG_SETMASK, &all, &before);
  const pid_t sweep = ::getpid();
  const pid_t process = ::fork();
  const int failure = errno;
  if (process == 0) become(arguments, sweep, before);
  ::sigprocmask(SIG_SETMASK, &before, nullptr);
  if (process < 0) throw std::system_error(failure, std::generic_category(), "cannot start " + words.front());
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
  if (process < 0 && errno == EINTR) return;
  if (process < 0) throw std::system_error(errno, std::generic_category(), "cannot wait for a run");
  const auto found = running.find(process);
  if (found == running.end()) return;
  SweepRun& run = *found->second;
  run.end = end_of(status, passed_on);
  std::printf("%s: %s\n", run.name.c_str(), name_of(run.end).c_str());
  static_cast<void>(lost_output());       // the summary says the same
  if (WIFSIGNALED(status) && !passed_on)  // a run that ends by itself has said why
    std::fprintf(stderr, "voussoir: the run %s was %s; --resume goes on with it\n", run.folder.c_str(),
                 name_of(run.end).c_str());
  running.erase(found);
}

void run_all(Sweep& sweep, const SweepOptions& options) {
  std::map<pid_t, SweepRun*> running;
  bool passed_on = false;
  try {
    for (SweepRun& run : sweep.runs) {
      while (static_cast<int>(running.size()) >= options.processes) wait_for_one(running, passed_on);
      if (interrupted()) break;
      running.emplace(start(run, sweep.base, options), &run);
    }
  } catch (...) {  // for example no process is left: the runs that have begun are stopped and waited for
    for (const auto& [child, run] : running) kill(child, SIGUSR1);
    passed_on = true;
    while (!running.empty()) wait_for_one(running, passed_on);
    throw;
  }
  while (!running.empty()) wait_for_one(running, passed_on);
}

/// The increments of a run; none where it has no results, or where they have vanished or are damaged.
std::vector<io::IncrementInfo> increments_of(const SweepRun& run) {
  try {
    if (std::filesystem::exists(run.folder / "run.h5")) return io::read_increments(run.folder / "run.h5");
  } catch (const std::exception& damage) {
    std::fprintf(stderr, "voussoir: the summary has no values of %s: %s\n", run.name.c_str(), damage.what());
  }
  return {};
}

/// Writes one row for each run: how it ended, and the further columns of its last increment.
void write_summary(const Sweep& sweep, const std::filesystem::path& file) {
  std::vector<std::vector<io::IncrementInfo>> tables;
  std::set<std::string> columns;
  for (const SweepRun& run : sweep.runs) {
    tables.push_back(increments_of(run));
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
  io::remove_leftovers(options.folder);
  if (!lock.note().empty()) std::printf("%s\n", lock.note().c_str());
  options.threads = threads_of_a_run(options);
  run_all(sweep, options);
  write_summary(sweep, options.folder / "summary.csv");
  std::printf("summary: %s\n", (options.folder / "summary.csv").c_str());
  static_cast<void>(lost_output());
  std::vector<RunEnd> ends;
  for (const SweepRun& run : sweep.runs) ends.push_back(run.end);
  return outcome_of(ends);
}

}  // namespace voussoir::host
