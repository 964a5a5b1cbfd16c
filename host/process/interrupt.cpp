#include "host/process/interrupt.hpp"

#include <csignal>

namespace voussoir::host {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

extern "C" void voussoir_on_signal(int signal) {
  stop_requested = 1;
  std::signal(signal, SIG_DFL);  // a second signal has its usual effect: it ends the process
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, voussoir_on_signal);
  std::signal(SIGTERM, voussoir_on_signal);
  std::signal(SIGUSR1, voussoir_on_signal);  // mpirun passes this signal on and does not end the ranks itself
}

bool interrupted() { return stop_requested != 0; }

}  // namespace voussoir::host
