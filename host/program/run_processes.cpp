#include "host/program/run_processes.hpp"

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
#include <fstream>
#include <map>
#include <string_view>
#include <system_error>
#include <thread>

#include "host/process/cores.hpp"
#include "host/process/interrupt.hpp"
#include "host/process/standard_streams.hpp"

namespace voussoir::host {
namespace {

/// The forked child's way to its program; it calls only what is allowed between fork and exec. If the parent dies, the
/// child gets SIGTERM, so that no run goes on that nobody waits for: a run on a mesh then ends after its increment, and
/// `--resume` goes on with it.
[[noreturn]] void become(const std::vector<char*>& arguments, const std::filesystem::path& complaints, pid_t parent,
                         const sigset_t& signals) {
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) ::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  ::sigprocmask(SIG_SETMASK, &signals, nullptr);
  if (::getppid() != parent)
    ::_exit(exit_code(Outcome::interrupted));         // the parent died before the child could ask to be told
  const int nowhere = ::open("/dev/null", O_WRONLY);  // the same lines are in run.log
  if (nowhere >= 0) ::dup2(nowhere, STDOUT_FILENO);
  if (!complaints.empty()) {
    const int kept = ::open(complaints.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (kept >= 0) ::dup2(kept, STDERR_FILENO);
  }
  ::execv(arguments.front(), arguments.data());
  constexpr std::string_view complaint = "voussoir: the program of a run cannot be started\n";
  static_cast<void>(!::write(STDERR_FILENO, complaint.data(), complaint.size()));
  ::_exit(exit_code(Outcome::machine_failure));
}

std::filesystem::path complaints_of(const ProcessRun& run, const ProcessOptions& options) {
  return options.complaints ? options.complaints(run) : std::filesystem::path{};
}

pid_t start(const ProcessRun& run, const ProcessOptions& options) {
  std::vector<std::string> words{options.program.string(), "run", run.case_file.string(), "-o", run.folder.string()};
  for (const std::string& value : run.overrides) words.insert(words.end(), {"--set", value});
  if (options.threads > 0) words.insert(words.end(), {"--threads", std::to_string(options.threads)});
  if (options.resume) words.emplace_back("--resume");
  if (options.take_over) words.emplace_back("--take-over");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const std::filesystem::path complaints = complaints_of(run, options);
  // A signal that came between fork and exec would be lost in a copy of this process.
  sigset_t all, before;
  sigfillset(&all);
  ::sigprocmask(SIG_SETMASK, &all, &before);
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  const int failure = errno;
  if (process == 0) become(arguments, complaints, parent, before);
  ::sigprocmask(SIG_SETMASK, &before, nullptr);
  if (process < 0) throw std::system_error(failure, std::generic_category(), "cannot start " + words.front());
  return process;
}

/// Shows what a run has written to its standard error, and keeps the last line as its reason.
void show_complaints(ProcessRun& run, const std::filesystem::path& file) {
  if (file.empty()) return;
  std::ifstream text(file);
  for (std::string line; std::getline(text, line);) {
    if (line.empty()) continue;
    std::fprintf(stderr, "%s\n", line.c_str());
    constexpr std::string_view prefix = "voussoir: ";
    run.reason = line.starts_with(prefix) ? line.substr(prefix.size()) : line;
  }
  std::error_code ignored;  // the file is removed for tidiness alone
  std::filesystem::remove(file, ignored);
}

/// Waits until one of the processes has ended and stores its exit code. A request to stop is passed on once, as
/// SIGUSR1: a terminal sends Ctrl-C to all processes, and a second SIGINT or SIGTERM would end a run at once.
void wait_for_one(std::map<pid_t, ProcessRun*>& running, bool& passed_on, const ProcessOptions& options) {
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
  ProcessRun& run = *found->second;
  run.end = end_of(status, passed_on);
  show_complaints(run, complaints_of(run, options));
  std::printf("%s: %s\n", run.name.c_str(), name_of(run.end).c_str());
  static_cast<void>(lost_output());       // the summary says the same
  if (WIFSIGNALED(status) && !passed_on)  // a run that ends by itself has said why
    std::fprintf(stderr, "voussoir: the run %s was %s; --resume goes on with it\n", run.folder.c_str(),
                 name_of(run.end).c_str());
  running.erase(found);
  if (options.on_end) options.on_end(run);
}

}  // namespace

void run_processes(std::span<ProcessRun> runs, const ProcessOptions& options) {
  std::map<pid_t, ProcessRun*> running;
  bool passed_on = false;
  try {
    for (ProcessRun& run : runs) {
      while (static_cast<int>(running.size()) >= options.processes) wait_for_one(running, passed_on, options);
      if (interrupted()) break;
      running.emplace(start(run, options), &run);
    }
    while (!running.empty()) wait_for_one(running, passed_on, options);
  } catch (...) {  // no process is left, or on_end fails: the runs that have begun are stopped and waited for
    for (const auto& [child, run] : running) kill(child, SIGUSR1);
    passed_on = true;
    ProcessOptions last = options;
    last.on_end = {};  // it may fail again
    while (!running.empty()) wait_for_one(running, passed_on, last);
    throw;
  }
}

int threads_of_a_run(const ProcessOptions& options) {
  const bool said = options.threads > 0 || getenv("OMP_NUM_THREADS") != nullptr ||
                    getenv("KOKKOS_NUM_THREADS") != nullptr;
  if (said || options.processes == 1) return options.threads;
  return std::max(1, cores_of_this_process().usable() / options.processes);
}

}  // namespace voussoir::host
