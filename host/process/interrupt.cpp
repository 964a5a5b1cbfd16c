#include "host/process/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <initializer_list>

namespace voussoir::host {
namespace {

volatile std::sig_atomic_t stop_requested = 0;
volatile std::sig_atomic_t code_at_once = 0;

extern "C" void voussoir_on_signal(int signal) {
  stop_requested = 1;
  std::signal(signal, SIG_DFL);  // a second signal has its usual effect: it ends the process
}

extern "C" void voussoir_end_on_signal(int /*signal*/) { _exit(code_at_once); }

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, voussoir_on_signal);
  std::signal(SIGTERM, voussoir_on_signal);
  std::signal(SIGUSR1, voussoir_on_signal);  // mpirun passes this signal on and does not end the ranks itself
}

void end_on_interrupts(int code) {
  code_at_once = code;
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, voussoir_end_on_signal);
}

bool interrupted() { return stop_requested != 0; }

}  // namespace voussoir::host
