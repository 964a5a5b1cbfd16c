#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "io/hdf5.hpp"
#include "io/hdf5_handle.hpp"

namespace voussoir::io {

namespace {

herr_t append_name(hid_t, const char* name, void* out) {
  static_cast<std::vector<std::string>*>(out)->emplace_back(name);
  return 0;
}

}  // namespace

void Hdf5File::require_checksum(const std::string& name, const void* values, std::size_t bytes) const {
  if (H5Aexists_by_name(file_, name.c_str(), "checksum", H5P_DEFAULT) <= 0) return;  // small, or of another program
  if (integer_attribute(name, "checksum") != checksum_of(values, bytes)) {
    throw std::runtime_error(
        fmt::format("{}: cannot read {} (it is damaged: its checksum is wrong)", path_.string(), name));
  }
}

bool Hdf5File::has(const std::string& name) const {
  // H5Lexists fails unless every group on the way exists.
  for (std::size_t slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    if (H5Lexists(file_, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) {
      H5Eclear2(H5E_DEFAULT);
      return false;
    }
  }
  return name == "/" || H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0;
}

void Hdf5File::require_format(const std::string& format, std::int64_t version, const std::string& what) const {
  if (text_attribute("/", "format") != format) {
    throw std::runtime_error(fmt::format("{}: it is not {}", path_.string(), what));
  }
  // A version that is no whole number must not be rounded to one that is known.
  const double found = number_attribute("/", "format_version");
  if (found != static_cast<double>(version)) {
    throw std::runtime_error(
        fmt::format("{}: its format_version is {}, but this program knows {} only: another "
                    "version of the program wrote the file",
                    path_.string(), found, version));
  }
}

std::vector<std::string> Hdf5File::members(const std::string& group) const {
  std::vector<std::string> names;
  if (has(group)) {
    const Handle opened(checked(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), "open " + group), H5Gclose);
    const auto take = [](hid_t id, const char* name, const H5L_info_t*, void* out) {
      return append_name(id, name, out);
    };
    checked(H5Literate(opened, H5_INDEX_NAME, H5_ITER_INC, nullptr, take, &names), "list " + group);
  }
  return names;
}

std::vector<std::string> Hdf5File::attributes(const std::string& object) const {
  std::vector<std::string> names;
  const auto take = [](hid_t id, const char* name, const H5A_info_t*, void* out) { return append_name(id, name, out); };
  checked(H5Aiterate_by_name(file_, object.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr, take, &names, H5P_DEFAULT),
          "list attributes of " + object);
  return names;
}

void Hdf5File::read_through(const std::string& group) const {
  for (const std::string& member : members(group)) {
    const std::string name = fmt::format("{}/{}", group == "/" ? "" : group, member);
    const Handle object(checked(H5Oopen(file_, name.c_str(), H5P_DEFAULT), "read " + name), H5Oclose);
    if (H5Iget_type(object) == H5I_GROUP) {
      read_through(name);
    } else if (H5Iget_type(object) == H5I_DATASET) {
      const Handle type(checked(H5Dget_type(object), "read " + name), H5Tclose);
      const H5T_class_t kind = H5Tget_class(type);
      if (kind == H5T_FLOAT) static_cast<void>(read_doubles(name));
      if (kind == H5T_INTEGER) static_cast<void>(read_integers(name));
      if (kind == H5T_STRING) static_cast<void>(read_texts(name));
    }
  }
}

std::vector<std::size_t> Hdf5File::shape(const std::string& name) const {
  const std::string what = fmt::format("read {}", name);
  const Handle set(checked(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), what), H5Dclose);
  const Handle space(checked(H5Dget_space(set), what), H5Sclose);
  std::vector<hsize_t> extents(static_cast<std::size_t>(checked(H5Sget_simple_extent_ndims(space), what)));
  checked(H5Sget_simple_extent_dims(space, extents.data(), nullptr), what);
  return {extents.begin(), extents.end()};
}

template <class T>
Array<T> Hdf5File::read_array(const std::string& name, Id type) const {
  const std::string what = fmt::format("read {}", name);
  const Handle set(checked(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), what), H5Dclose);
  Array<T> array{.shape = shape(name), .values = {}};
  std::size_t count = 1;
  for (const std::size_t n : array.shape) {
    count *= n;
  }
  array.values.resize(count);
  if (count > 0) {
    checked(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()), what);
  }
  require_checksum(name, array.values.data(), count * sizeof(T));
  return array;
}

Array<double> Hdf5File::read_doubles(const std::string& name) const {
  return read_array<double>(name, H5T_NATIVE_DOUBLE);
}

Array<std::int64_t> Hdf5File::read_integers(const std::string& name) const {
  return read_array<std::int64_t>(name, H5T_NATIVE_INT64);
}

std::string Hdf5File::read_text(const std::string& name) const {
  const auto texts = read_texts(name);
  return texts.empty() ? "" : texts.front();
}

std::vector<std::string> Hdf5File::read_texts(const std::string& name) const {
  const std::string what = fmt::format("read {}", name);
  const Handle set(checked(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), what), H5Dclose);
  const Handle stored(checked(H5Dget_type(set), what), H5Tclose);
  const Handle space(checked(H5Dget_space(set), what), H5Sclose);
  if (H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) != 0) {
    throw std::runtime_error(fmt::format("{}: {} is not a fixed-length text", path_.string(), name));
  }
  const std::size_t size = H5Tget_size(stored);
  const auto count = static_cast<std::size_t>(checked(H5Sget_simple_extent_npoints(space), what));
  std::string packed(size * count, '\0');
  if (count > 0) {
    checked(H5Dread(set, stored, H5S_ALL, H5S_ALL, H5P_DEFAULT, packed.data()), what);
  }
  require_checksum(name, packed.data(), packed.size());
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    texts.emplace_back(packed.substr(i * size, size).c_str());
  }
  return texts;
}

std::string Hdf5File::text_attribute(const std::string& object, const std::string& name) const {
  const std::string what = fmt::format("read attribute {} of {}", name, object);
  const Handle attribute(checked(H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), what),
                         H5Aclose);
  const Handle stored(checked(H5Aget_type(attribute), what), H5Tclose);
  if (H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) != 0) {
    throw std::runtime_error(
        fmt::format("{}: attribute {} of {} is not a fixed-length text", path_.string(), name, object));
  }
  std::string text(H5Tget_size(stored), '\0');
  checked(H5Aread(attribute, stored, text.data()), what);
  return text.c_str();  // NOLINT(readability-redundant-string-cstr): the text ends at its first NUL
}

void Hdf5File::get_scalar(const std::string& object, const std::string& name, Id type, void* value) const {
  const std::string what = fmt::format("read attribute {} of {}", name, object);
  const Handle attribute(checked(H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), what),
                         H5Aclose);
  const Handle space(checked(H5Aget_space(attribute), what), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1) {
    throw std::runtime_error(fmt::format("{}: attribute {} of {} is not a single value", path_.string(), name, object));
  }
  checked(H5Aread(attribute, type, value), what);
}

double Hdf5File::number_attribute(const std::string& object, const std::string& name) const {
  double value = 0;
  get_scalar(object, name, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::int64_t Hdf5File::integer_attribute(const std::string& object, const std::string& name) const {
  std::int64_t value = 0;
  get_scalar(object, name, H5T_NATIVE_INT64, &value);
  return value;
}

}  // namespace voussoir::io
