#include "io/hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/hdf5_handle.hpp"
#include "io/superblock.hpp"
#include "io/text_file.hpp"

namespace voussoir::io {

namespace {

/// Below this size an array stands in the header of its dataset, whose checksum holds for it as well [bytes].
constexpr std::size_t most_in_header = 4096;
constexpr std::size_t memory_step = std::size_t{1} << 20;  ///< by which a file in memory grows [bytes]

/// HDF5 prints its error stack by default; here the innermost entry becomes part of an exception instead.
void be_quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

/// Locked by the thread that uses HDF5; a thread may have several files open. HDF5 is told first to do nothing when the
/// program exits: there is no file of its own to save, and where memory has run out its exit handler ends in a
/// segmentation fault.
std::recursive_mutex& one_thread() {
  static std::recursive_mutex mutex;
  static const bool without_exit_handler = H5dont_atexit() >= 0;
  static_cast<void>(without_exit_handler);
  return mutex;
}

std::string innermost_reason() {
  std::string reason;
  const auto take = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
    *static_cast<std::string*>(out) = error->desc != nullptr ? error->desc : "";
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, take, &reason);
  H5Eclear2(H5E_DEFAULT);
  std::replace(reason.begin(), reason.end(), '\n', ' ');  // a date within it ends in one
  return reason;
}

Handle making_groups() {
  const hid_t list = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(list, 1);
  return {list, H5Pclose};
}

Handle text_type(std::size_t size) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, size);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return {type, H5Tclose};
}

/// Properties of a dataset of `bytes` bytes: small ones stand in the header.
Handle storage_for(std::size_t bytes) {
  const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
  if (bytes > 0 && bytes <= most_in_header) H5Pset_layout(list, H5D_COMPACT);
  return {list, H5Pclose};
}

}  // namespace

Hdf5File::Hdf5File(Id file, std::filesystem::path path) : turn_(one_thread()), file_(file), path_(std::move(path)) {}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : turn_(std::move(other.turn_)), file_(std::exchange(other.file_, -1)), path_(std::move(other.path_)) {}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) {
    H5Fclose(file_);
  }
}

Hdf5File::Id Hdf5File::checked(Id id, const std::string& what) const {
  if (id < 0) {
    throw std::runtime_error(fmt::format("{}: cannot {} ({})", path_.string(), what, innermost_reason()));
  }
  return id;
}

namespace {

/// Makes sure that there is memory for what HDF5 takes for a file (some 1 MB, most of it for its cache of metadata),
/// because HDF5 1.10 uses the cache without a look at whether there was memory for it.
/// @throws std::bad_alloc
void ask_for_memory() {
  constexpr std::size_t enough = std::size_t{4} << 20;
  void* volatile room = std::malloc(enough);  // volatile, since a compiler may leave out memory that nobody uses
  if (room == nullptr) throw std::bad_alloc();
  std::free(room);
}

}  // namespace

Hdf5File Hdf5File::create(const std::filesystem::path& path) {
  Hdf5File file(-1, path);
  ask_for_memory();
  be_quiet();
  const Handle access(file.checked(H5Pcreate(H5P_FILE_ACCESS), "create the file"), H5Pclose);
  file.checked(H5Pset_fapl_core(access, memory_step, 0), "create the file");
  file.checked(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18), "create the file");
  // HDF5 first tries to open an existing file, which would be read into memory in vain; no file can have this name.
  const std::string name = "/dev/null/" + path.filename().string();
  file.file_ = file.checked(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), "create the file");
  return file;
}

Hdf5File Hdf5File::open(const std::filesystem::path& path) {
  const std::string fault = file_fault(path);  // HDF5 would wait for a pipe
  if (!fault.empty()) {
    throw std::runtime_error(fmt::format("{}: cannot open the file: it {}", in_one_line(path.string()), fault));
  }
  Hdf5File file(-1, path);
  ask_for_memory();
  be_quiet();
  file.file_ = file.checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "open the file");
  return file;
}

void Hdf5File::publish() {
  checked(H5Fflush(file_, H5F_SCOPE_GLOBAL), "finish the file");
  std::vector<std::byte> image(
      static_cast<std::size_t>(checked(H5Fget_file_image(file_, nullptr, 0), "finish the file")));
  checked(H5Fget_file_image(file_, image.data(), image.size()), "finish the file");
  renew_superblock_checksum(image);
  checked(H5Fclose(std::exchange(file_, -1)), "finish the file");
  AtomicFile target(path_);
  target.write(image);
  target.publish();
}

void Hdf5File::write_array(const std::string& name, const void* values, std::size_t count,
                           const std::vector<std::size_t>& shape, Id type, const std::string& unit) {
  std::size_t expected = 1;
  std::vector<hsize_t> extents;
  for (const std::size_t n : shape) {
    expected *= n;
    extents.push_back(n);
  }
  if (count != expected) {
    throw std::invalid_argument(fmt::format("{}: there are {} values for {} places", name, count, expected));
  }
  const std::string what = fmt::format("write {}", name);
  const Handle space(checked(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), what),
                     H5Sclose);
  const Handle links = making_groups();
  const Handle storage = storage_for(count * H5Tget_size(type));
  const Handle set(checked(H5Dcreate2(file_, name.c_str(), type, space, links, storage, H5P_DEFAULT), what), H5Dclose);
  if (count > 0) {
    checked(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), what);
  }
  set_attribute(name, "unit", unit);
  add_checksum(name, values, count * H5Tget_size(type));
}

void Hdf5File::write(const std::string& name, std::span<const double> values, const std::vector<std::size_t>& shape,
                     const std::string& unit) {
  write_array(name, values.data(), values.size(), shape, H5T_NATIVE_DOUBLE, unit);
}

void Hdf5File::write(const std::string& name, std::span<const std::int64_t> values,
                     const std::vector<std::size_t>& shape, const std::string& unit) {
  write_array(name, values.data(), values.size(), shape, H5T_NATIVE_INT64, unit);
}

void Hdf5File::add_checksum(const std::string& name, const void* values, std::size_t bytes) {
  if (bytes > most_in_header) set_attribute(name, "checksum", checksum_of(values, bytes));
}

void Hdf5File::write_text(const std::string& name, const std::string& text) {
  const std::string what = fmt::format("write {}", name);
  const Handle type = text_type(text.size() + 1);
  const Handle space(checked(H5Screate(H5S_SCALAR), what), H5Sclose);
  const Handle links = making_groups();
  const Handle storage = storage_for(text.size() + 1);
  const Handle set(checked(H5Dcreate2(file_, name.c_str(), type, space, links, storage, H5P_DEFAULT), what), H5Dclose);
  checked(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), what);
  add_checksum(name, text.c_str(), text.size() + 1);
}

void Hdf5File::write_texts(const std::string& name, const std::vector<std::string>& texts) {
  std::size_t size = 1;
  for (const auto& text : texts) {
    size = std::max(size, text.size() + 1);
  }
  std::string packed(size * texts.size(), '\0');
  for (std::size_t i = 0; i < texts.size(); ++i) {
    packed.replace(i * size, texts[i].size(), texts[i]);
  }
  const Handle type = text_type(size);
  write_array(name, packed.data(), texts.size(), {texts.size()}, type, "-");
}

void Hdf5File::make_group(const std::string& name) {
  const Handle links = making_groups();
  const Handle group(checked(H5Gcreate2(file_, name.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), "make group " + name),
                     H5Gclose);
}

void Hdf5File::link_external(const std::string& name, const std::string& file, const std::string& object) {
  const Handle links = making_groups();
  checked(H5Lcreate_external(file.c_str(), object.c_str(), file_, name.c_str(), links, H5P_DEFAULT), "link " + name);
}

void Hdf5File::set_scalar(const std::string& object, const std::string& name, Id type, const void* value) {
  const std::string what = fmt::format("write attribute {} of {}", name, object);
  const Handle space(checked(H5Screate(H5S_SCALAR), what), H5Sclose);
  const Handle attribute(checked(H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                                   H5P_DEFAULT, H5P_DEFAULT),
                                 what),
                         H5Aclose);
  checked(H5Awrite(attribute, type, value), what);
}

void Hdf5File::set_attribute(const std::string& object, const std::string& name, const std::string& value) {
  const Handle type = text_type(value.size() + 1);
  set_scalar(object, name, type, value.c_str());
}

void Hdf5File::set_attribute(const std::string& object, const std::string& name, double value) {
  set_scalar(object, name, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5File::set_attribute(const std::string& object, const std::string& name, std::int64_t value) {
  set_scalar(object, name, H5T_NATIVE_INT64, &value);
}

}  // namespace voussoir::io
