#pragma once
/// What stands behind every function of voussoir.h: the one lock, the handles, and the way from an exception to a code
/// and a sentence.

#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "host/library/grain_batch.hpp"
#include "host/library/rves.hpp"
#include "host/library/voussoir.h"

namespace voussoir::library {

/// A call that is wrong, whatever the input is.
class Misuse : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// The RVEs of a handle, and what its calls need from one call to the next.
struct CRves {
  std::unique_ptr<GrainBatch> batch;
  std::vector<PointReport> points;       ///< (RVE) of the last answers
  std::optional<VoussoirReport> report;  ///< of the last evaluation
  std::vector<fem::PointField> fields;   ///< of the committed state; empty: to be computed
};

/// The RVEs of a handle. Throws Misuse where the handle is none, or where its RVEs are freed.
CRves& rves_of(const VoussoirRves* handle);
/// The same, with nullptr instead of an exception.
const CRves* find_rves(const VoussoirRves* handle);
VoussoirRves* new_handle(std::unique_ptr<CRves> rves);
void free_rves(const VoussoirRves* handle);

void start_threads(int threads);  ///< throws Misuse where they run with another number, or have ended
void stop_threads();
[[nodiscard]] int running_threads();  ///< 0: none
void require_threads();               ///< throws Misuse where they do not run

/// Holds the one lock of the interface during a call. Throws Misuse in a forked process, and where a call is made
/// within another one of the same thread.
class Call {
 public:
  Call();
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
};

/// Stores the sentence of an exception for voussoir_last_error, and returns its code.
int remember(const char* function, const std::exception_ptr& exception) noexcept;
/// Stores a sentence.
void remember(const std::string& sentence) noexcept;
[[nodiscard]] const char* last_error() noexcept;

/// Runs the body of a C function under the lock. It returns a code, or nothing where it is right whenever it ends. No
/// exception leaves this function.
template <class Body>
int guarded(const char* function, Body&& body) noexcept {
  try {
    const Call call;
    if constexpr (std::is_void_v<decltype(body())>) {
      body();
      return voussoir_ok;
    } else {
      return body();
    }
  } catch (...) {
    return remember(function, std::current_exception());
  }
}

/// The same for a function that needs the RVEs of a handle.
template <class Body>
int guarded(const char* function, const VoussoirRves* handle, Body&& body) noexcept {
  return guarded(function, [&] { return body(rves_of(handle)); });
}

}  // namespace voussoir::library
