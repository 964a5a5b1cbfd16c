// The two functions of io/packing_file.hpp that know the format of packing files, in place of those of
// io/packing_hdf5.cpp. They call the Python package, which reads and writes HDF5 by h5py: so the module links no HDF5
// library, which another module might have in another version. They are called without the interpreter lock.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/packing_file.hpp"
#include "io/superblock.hpp"
#include "python/src/packings.hpp"

namespace nb = nanobind;

namespace voussoir::io {
namespace {

/// Runs `work`; an exception of Python becomes one of the kind that callers of these functions expect.
template <class Work>
auto in_python(const Work& work) {
  const nb::gil_scoped_acquire lock;
  try {
    return work(nb::module_::import_("voussoir.packing_storage"));
  } catch (nb::python_error& error) {
    if (!error.matches(PyExc_Exception)) throw;  // KeyboardInterrupt
    throw std::runtime_error(nb::str(error.value()).c_str());
  }
}

}  // namespace

void save_packing(const std::filesystem::path& path, const Packing& packing) {
  const std::string problem = disagreement_of(packing);
  if (!problem.empty()) throw std::invalid_argument("packing for " + path.string() + ": " + problem);
  in_python([&](const nb::module_& files) { files.attr("write")(path.string(), python::dict_of(packing)); });
}

Packing load_packing(const std::filesystem::path& path) {
  return in_python([&](const nb::module_& files) {
    return python::packing_of(nb::cast<nb::dict>(files.attr("read")(path.string())));
  });
}

}  // namespace voussoir::io

namespace voussoir::python {

/// Writes the image of an HDF5 file as the program does: completely or not at all.
void publish(const std::string& path, const nb::bytes& image) {
  const auto* const first = static_cast<const std::byte*>(image.data());
  std::vector<std::byte> bytes(first, first + image.size());
  const nb::gil_scoped_release free;
  io::renew_superblock_checksum(bytes);
  io::AtomicFile target(path);
  target.write(bytes);
  target.publish();
}

}  // namespace voussoir::python
