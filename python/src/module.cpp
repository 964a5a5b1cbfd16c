// The compiled part of the Python package voussoir: the engine, packings and batches of RVEs. It translates; what it
// calls stands in host/library.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <exception>
#include <stdexcept>

#include "host/process/build_info.hpp"
#include "host/process/exit_code.hpp"
#include "io/input_error.hpp"
#include "kernels/state/rve_batch.hpp"
#include "python/src/engine.hpp"
#include "python/src/packings.hpp"

namespace nb = nanobind;

namespace voussoir::python {
namespace {

void raise(const char* name, const nb::object& value) {
  PyErr_SetObject(nb::module_::import_("voussoir.errors").attr(name).ptr(), value.ptr());
}

/// Exceptions of the C++ code as those of voussoir.errors. What this function throws is left to nanobind, which has
/// ValueError for std::invalid_argument, IndexError for std::out_of_range and MemoryError for std::bad_alloc.
void translate(const std::exception_ptr& thrown, void* /*unused*/) {
  try {
    std::rethrow_exception(thrown);
  } catch (const nb::builtin_exception&) {
    throw;
  } catch (const std::invalid_argument&) {
    throw;
  } catch (const std::out_of_range&) {
    throw;
  } catch (const io::InputError& error) {
    raise("InputError", nb::make_tuple(error.what(), error.place(), error.key(), error.sentence()));
  } catch (const host::NoEquilibrium& error) {
    raise("NoEquilibrium", nb::str(error.what()));
  } catch (const std::runtime_error& error) {
    raise("Error", nb::str(error.what()));
  } catch (const std::logic_error& error) {  // such as a commit without an evaluation
    raise("Error", nb::str(error.what()));
  }
}

std::vector<std::string> status_names() {
  std::vector<std::string> names;
  for (auto status = kernels::RveStatus::converged; status <= kernels::RveStatus::not_finite;
       status = static_cast<kernels::RveStatus>(static_cast<int>(status) + 1)) {
    names.emplace_back(kernels::name_of(status));
  }
  return names;
}

}  // namespace
}  // namespace voussoir::python

NB_MODULE(_core, module) {
  namespace python = voussoir::python;
  namespace engine = python::engine;
  nb::register_exception_translator(python::translate);
  module.doc() = "The engine of the package voussoir. Use the names of the package; those here may change.";
  module.def("initialize", &engine::start, nb::arg("threads"));
  module.def("is_initialized", &engine::started);
  module.def("threads", &engine::threads);
  module.def("finish", &engine::finish);
  module.def("status_names", &python::status_names, "Names of the numbers in the column `status` of a report.");
  python::bind_packings(module);
  python::bind_batch(module);
}
