#pragma once
/// HDF5 through its C interface, reduced to what this program writes: n-dimensional float64/int64 arrays with a unit,
/// text, attributes, external links. Every failure is a std::runtime_error naming the file, the object and HDF5's own
/// reason.

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace voussoir::io {

template <class T>
struct Array {
  std::vector<std::size_t> shape = {};
  std::vector<T> values = {};  ///< row by row, last index fastest
};

/// An open file; closed by the destructor. Objects are named by paths ("/mesh/coordinates"); groups on the way to a new
/// object are made as needed.
///
/// A new file is made in memory, and `publish` gives its bytes to an AtomicFile. HDF5 itself never writes to a disk,
/// because after a failed write it cannot close its file and ends in a segmentation fault when the program exits.
///
/// Not every build of HDF5 may be used by two threads at a time. A file that is open keeps all other threads from
/// opening or making one, until it is closed; it must be closed by the thread that has opened it.
///
/// HDF5 may also end in a segmentation fault where it reads damaged metadata. A file is therefore written in the format
/// of HDF5 1.8, in which every piece of metadata has a checksum. Small arrays are metadata too; larger ones have an
/// attribute `checksum`, which is compared when they are read. Files without checksums are read as well.
class Hdf5File {
 public:
  [[nodiscard]] static Hdf5File create(const std::filesystem::path& path);
  [[nodiscard]] static Hdf5File open(const std::filesystem::path& path);
  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&&) = delete;
  ~Hdf5File();

  /// Writes a file that was created, completely or not at all, and closes it. Without this call nothing is written.
  void publish();

  void write(const std::string& name, std::span<const double> values, const std::vector<std::size_t>& shape,
             const std::string& unit);
  void write(const std::string& name, std::span<const std::int64_t> values, const std::vector<std::size_t>& shape,
             const std::string& unit);
  void write_text(const std::string& name, const std::string& text);
  void write_texts(const std::string& name, const std::vector<std::string>& texts);
  void make_group(const std::string& name);
  /// The linked file's name is relative to the folder of this file.
  void link_external(const std::string& name, const std::string& file, const std::string& object);

  void set_attribute(const std::string& object, const std::string& name, const std::string& value);
  void set_attribute(const std::string& object, const std::string& name, double value);
  void set_attribute(const std::string& object, const std::string& name, std::int64_t value);

  [[nodiscard]] bool has(const std::string& name) const;
  /// Throws unless the attributes `format` and `format_version` of "/" are these; `what` names such a file.
  void require_format(const std::string& format, std::int64_t version, const std::string& what) const;
  /// Names below a group in alphabetical order; empty for a group that does not exist.
  [[nodiscard]] std::vector<std::string> members(const std::string& group) const;
  [[nodiscard]] std::vector<std::string> attributes(const std::string& object) const;

  /// Reads all arrays and texts below a group, whose checksums are thereby compared. Throws where one is damaged.
  void read_through(const std::string& group) const;

  [[nodiscard]] std::vector<std::size_t> shape(const std::string& name) const;
  [[nodiscard]] Array<double> read_doubles(const std::string& name) const;
  [[nodiscard]] Array<std::int64_t> read_integers(const std::string& name) const;
  [[nodiscard]] std::string read_text(const std::string& name) const;
  [[nodiscard]] std::vector<std::string> read_texts(const std::string& name) const;
  [[nodiscard]] std::string text_attribute(const std::string& object, const std::string& name) const;
  [[nodiscard]] double number_attribute(const std::string& object, const std::string& name) const;
  [[nodiscard]] std::int64_t integer_attribute(const std::string& object, const std::string& name) const;

 private:
  using Id = std::int64_t;  ///< HDF5's hid_t
  Hdf5File(Id file, std::filesystem::path path);
  void write_array(const std::string& name, const void* values, std::size_t count,
                   const std::vector<std::size_t>& shape, Id type, const std::string& unit);
  template <class T>
  [[nodiscard]] Array<T> read_array(const std::string& name, Id type) const;
  void add_checksum(const std::string& name, const void* values, std::size_t bytes);
  void require_checksum(const std::string& name, const void* values, std::size_t bytes) const;
  void set_scalar(const std::string& object, const std::string& name, Id type, const void* value);
  void get_scalar(const std::string& object, const std::string& name, Id type, void* value) const;
  /// Returns `id` when it is valid; otherwise throws, with the action that was tried and HDF5's reason.
  Id checked(Id id, const std::string& what) const;

  std::unique_lock<std::recursive_mutex> turn_;  ///< of the thread that uses HDF5
  Id file_;
  std::filesystem::path path_;
};

}  // namespace voussoir::io
