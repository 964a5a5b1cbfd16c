#pragma once
/// Gmsh's global state, and its exceptions.

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace voussoir::fem {

/// Owns Gmsh's global state while one mesh is made or read. Gmsh sets the process's OpenMP thread number to its own;
/// the destructor restores the number, because otherwise everything after a mesh would run on one thread.
class GmshSession {
 public:
  GmshSession();
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

 private:
  int threads_before_;
};

/// What `call` returns. Throws std::bad_alloc where memory is lacking, otherwise std::runtime_error of `prefix` and
/// Gmsh's message, whichever type Gmsh throws.
template <class Call>
auto call_gmsh(Call&& call, const std::string& prefix) {
  try {
    return call();
  } catch (const std::string& message) {  // Gmsh 4.8 throws texts
    throw std::runtime_error(prefix + message);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::length_error&) {  // a list with more entries than any memory holds
    throw std::bad_alloc();
  } catch (const std::exception& error) {  // later versions
    throw std::runtime_error(prefix + error.what());
  } catch (int code) {  // the wrapper of older versions
    throw std::runtime_error(prefix + "error " + std::to_string(code));
  }
}

}  // namespace voussoir::fem
