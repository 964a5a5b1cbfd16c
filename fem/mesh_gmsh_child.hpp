#pragma once
/// A child process for code that may crash or never end.

#include <cstddef>
#include <functional>
#include <string>

namespace voussoir::fem {

struct ChildLimits {
  double seconds = 0;     ///< until the child is killed
  std::size_t bytes = 0;  ///< of address space beyond that of this process
};

/// The text that `work` returns in a copy of this process, which has ended when the function returns. The copy has one
/// thread and must not wait for another one; what it prints is lost, and it leaves no core file. A request to stop
/// (such as SIGINT) reaches this process only; the copy ends with it. Throws std::runtime_error of the sentence of an
/// exception of `work`, or where the copy was ended by a signal or ended itself, did not come to an end within its
/// time, needed more memory, or could not be made.
[[nodiscard]] std::string in_child(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace voussoir::fem
