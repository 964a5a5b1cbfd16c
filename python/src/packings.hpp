#pragma once
/// Packings as Python sees them: dictionaries of NumPy arrays, texts and numbers, with the names of a packing file.

#include <nanobind/nanobind.h>

#include <string>

#include "io/packing_file.hpp"

namespace voussoir::python {

/// Both need the interpreter lock. packing_of throws nanobind::builtin_exception or python_error for a wrong
/// dictionary.
[[nodiscard]] nanobind::dict dict_of(const io::Packing& packing);
[[nodiscard]] io::Packing packing_of(const nanobind::dict& dict);

/// Writes the image of an HDF5 file, completely or not at all.
void publish(const std::string& path, const nanobind::bytes& image);

void bind_packings(nanobind::module_& module);
void bind_batch(nanobind::module_& module);

}  // namespace voussoir::python
