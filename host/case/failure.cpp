#include "host/case/failure.hpp"

#include <filesystem>
#include <new>
#include <stdexcept>

#include "io/input_error.hpp"
#include "kernels/isa/choose_lanes.hpp"

namespace voussoir::host {

Failure failure_of(const std::exception_ptr& exception) {
  if (!exception) return {Outcome::machine_failure, "an error within the program: it was ended without a reason"};
  try {
    std::rethrow_exception(exception);
  } catch (const io::InputError& error) {
    return {Outcome::wrong_input, error.what()};
  } catch (const kernels::UnusableLanes& error) {
    return {Outcome::wrong_input, error.what()};
  } catch (const NoEquilibrium& error) {
    return {Outcome::no_equilibrium, error.what()};
  } catch (const Interrupted& error) {
    return {Outcome::interrupted, error.what()};
  } catch (const std::bad_alloc&) {
    return {Outcome::machine_failure, "out of memory"};
  } catch (const std::length_error&) {  // of a container that would be larger than any memory
    return {Outcome::machine_failure, "out of memory"};
  } catch (const std::logic_error& error) {
    return {Outcome::machine_failure, std::string("an error within the program: ") + error.what()};
  } catch (const std::filesystem::filesystem_error& error) {  // its own sentence is one for programmers
    return {Outcome::machine_failure, error.path1().string() + ": " + error.code().message()};
  } catch (const std::exception& error) {
    return {Outcome::machine_failure, error.what()};
  } catch (...) {
    return {Outcome::machine_failure, "an error within the program: an exception of unknown type"};
  }
}

}  // namespace voussoir::host
