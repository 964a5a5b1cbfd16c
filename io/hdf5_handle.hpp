#pragma once
/// What hdf5.cpp and hdf5_read.cpp share; no other file includes this one.

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "io/checksum.hpp"

namespace voussoir::io {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

/// Closes an HDF5 object at the end of its scope.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// The value of an array's attribute `checksum`.
[[nodiscard]] inline std::int64_t checksum_of(const void* values, std::size_t bytes) {
  Checksum sum;
  sum.add(std::span(static_cast<const std::byte*>(values), bytes));
  return static_cast<std::int64_t>(sum.value());
}

}  // namespace voussoir::io
