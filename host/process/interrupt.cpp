#include "host/process/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace voussoir::host {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

extern "C" void voussoir_on_signal(int signal) {
  stop_requested = 1;
  // A second signal has its usual effect: it ends the process. A second SIGHUP does not, because a closed terminal may
  // send two, one from the kernel and one from the shell.
  if (signal != SIGHUP) std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action{};
  action.sa_handler = voussoir_on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  // mpirun passes SIGUSR1 on and does not end the ranks itself.
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) sigaction(signal, &action, nullptr);
  struct sigaction hangup{};
  const bool under_nohup = sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler == SIG_IGN;
  if (!under_nohup) sigaction(SIGHUP, &action, nullptr);
}

bool interrupted() { return stop_requested != 0; }

}  // namespace voussoir::host
