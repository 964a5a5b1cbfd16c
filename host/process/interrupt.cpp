#include "host/process/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <initializer_list>
#include <string_view>

namespace voussoir::host {
namespace {

volatile std::sig_atomic_t stop_requested = 0;
volatile std::sig_atomic_t code_at_once = 0;

extern "C" void voussoir_on_signal(int signal) {
  stop_requested = 1;
  // A second signal has its usual effect: it ends the process. A second SIGHUP does not, because a closed terminal may
  // send two, one from the kernel and one from the shell; nor does SIGXCPU, which the kernel sends every second.
  if (signal != SIGHUP && signal != SIGXCPU) std::signal(signal, SIG_DFL);
}

extern "C" void voussoir_end_on_signal(int /*signal*/) {
  constexpr std::string_view
      line = "voussoir: stopped on request; packings and tests that were not finished begin anew\n";
  static_cast<void>(!::write(STDERR_FILENO, line.data(), line.size()));
  _exit(code_at_once);
}

/// Gives all requests to stop to a handler. mpirun passes SIGUSR1 on and does not end the ranks itself. Under nohup
/// SIGHUP is ignored and stays so.
void handle_requests(void (*handler)(int)) {
  struct sigaction action{};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1, SIGXCPU}) sigaction(signal, &action, nullptr);
  struct sigaction hangup{};
  const bool under_nohup = sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler == SIG_IGN;
  if (!under_nohup) sigaction(SIGHUP, &action, nullptr);
}

}  // namespace

void catch_interrupts() { handle_requests(voussoir_on_signal); }

void end_on_interrupts(int code) {
  code_at_once = code;
  handle_requests(voussoir_end_on_signal);
}

bool interrupted() { return stop_requested != 0; }

}  // namespace voussoir::host
