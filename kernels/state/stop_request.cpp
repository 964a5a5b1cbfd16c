#include "kernels/state/stop_request.hpp"

namespace voussoir::kernels {
namespace {

thread_local const std::atomic<bool>* flag_of_thread = nullptr;

}  // namespace

Stopped::~Stopped() = default;

Stoppable::Stoppable(const std::atomic<bool>& flag) { flag_of_thread = &flag; }

Stoppable::~Stoppable() { flag_of_thread = nullptr; }

const std::atomic<bool>* stop_flag() { return flag_of_thread; }

void end_where_stopped(const std::atomic<bool>* flag) {
  if (flag != nullptr && flag->load(std::memory_order_relaxed)) throw Stopped();
}

}  // namespace voussoir::kernels
