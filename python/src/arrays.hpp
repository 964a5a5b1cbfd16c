#pragma once
/// NumPy arrays of C++ values. Each function needs the interpreter lock.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

namespace voussoir::python {

namespace nb = nanobind;

/// Memory that belongs to a NumPy array which is made later.
template <class T>
class NewArray {
 public:
  explicit NewArray(std::size_t count) : data_(std::make_unique_for_overwrite<T[]>(count)), count_(count) {}
  [[nodiscard]] std::span<T> values() { return {data_.get(), count_}; }
  /// The array, which has the memory from now on.
  [[nodiscard]] nb::object give(std::initializer_list<std::size_t> shape) {
    T* const data = data_.get();
    const nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    static_cast<void>(data_.release());
    return nb::cast(nb::ndarray<nb::numpy, T>(data, shape, owner));
  }

 private:
  std::unique_ptr<T[]> data_;
  std::size_t count_;
};

/// A copy of these values. @param shape with as many places as there are values
template <class T>
[[nodiscard]] nb::object array_of(const std::vector<T>& values, std::initializer_list<std::size_t> shape) {
  NewArray<T> array(values.size());
  std::copy(values.begin(), values.end(), array.values().begin());
  return array.give(shape);
}

template <class T>
[[nodiscard]] nb::object array_of(const std::vector<T>& values) {
  return array_of(values, {values.size()});
}

}  // namespace voussoir::python
