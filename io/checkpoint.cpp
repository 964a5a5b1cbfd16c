#include "io/checkpoint.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "io/atomic_file.hpp"
#include "io/checksum.hpp"
#include "io/input_error.hpp"
#include "io/regular_file.hpp"

namespace voussoir::io {

namespace {

constexpr std::string_view magic = "voussoir checkpoint 2";
namespace fs = std::filesystem;

template <class T>
std::vector<std::byte> bytes_of(std::span<const T> values) {
  const auto bytes = std::as_bytes(values);
  return {bytes.begin(), bytes.end()};
}

template <class T>
std::vector<T> values_of(const std::string& name, const std::vector<std::byte>& bytes) {
  if (bytes.size() % sizeof(T) != 0) {
    throw std::runtime_error(
        fmt::format("checkpoint: \"{}\" has {} bytes, which is no multiple of {}", name, bytes.size(), sizeof(T)));
  }
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!bytes.empty()) {
    std::memcpy(values.data(), bytes.data(), bytes.size());
  }
  return values;
}

/// Writes pieces and keeps the checksum of all of them.
class HashedWriter {
 public:
  explicit HashedWriter(const fs::path& target) : file_(target) {}

  void bytes(std::span<const std::byte> piece) {
    sum_.add(piece);
    file_.write(piece);
    written_ += piece.size();
  }
  void integer(std::uint64_t value) { bytes(std::as_bytes(std::span(&value, 1))); }
  void text(std::string_view value) {
    integer(value.size());
    bytes(std::as_bytes(std::span(value.data(), value.size())));
  }
  void late_bytes(const std::string& name, const LateBytes& value) {
    const std::size_t size = value.size();
    integer(size);
    const std::size_t before = written_;
    value.write([this](std::span<const std::byte> piece) { bytes(piece); });
    if (written_ - before != size) {
      throw std::logic_error(fmt::format("checkpoint: \"{}\" has {} bytes and not {}", name, written_ - before, size));
    }
  }
  /// Ends the file with the checksum and gives it its name; returns its size.
  std::size_t publish() {
    integer(sum_.value());
    file_.publish();
    return written_;
  }

 private:
  AtomicFile file_;
  Checksum sum_;
  std::size_t written_ = 0;
};

/// Takes pieces from bytes whose checksum is right. A length that goes beyond their end throws nevertheless.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  std::span<const std::byte> take(std::uint64_t size) {
    if (size > rest_.size()) {
      throw std::runtime_error("ends too early");
    }
    const auto piece = rest_.first(size);
    rest_ = rest_.subspan(size);
    return piece;
  }
  std::uint64_t integer() {
    std::uint64_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() {
    const auto piece = take(integer());
    return {reinterpret_cast<const char*>(piece.data()), piece.size()};
  }

 private:
  std::span<const std::byte> rest_;
};

struct Content {
  std::string fingerprint;
  Checkpoint checkpoint;
};

/// Throws std::runtime_error with a reason when the file is damaged.
Content read(const fs::path& path) {
  const std::vector<std::byte> all = read_regular(path);
  if (all.size() < sizeof(std::uint64_t)) {
    throw std::runtime_error("is empty");
  }
  const auto body = std::span<const std::byte>(all).first(all.size() - sizeof(std::uint64_t));
  Checksum sum;
  sum.add(body);
  if (Reader(std::span<const std::byte>(all).last(sizeof(std::uint64_t))).integer() != sum.value()) {
    throw std::runtime_error("is damaged: its checksum is wrong");
  }
  Reader reader(body);
  if (reader.text() != magic) {
    throw std::runtime_error("is not a checkpoint of this version");
  }
  Content content{.fingerprint = reader.text(), .checkpoint = {}};
  for (std::uint64_t left = reader.integer(); left > 0; --left) {
    const std::string name = reader.text();
    const auto blob = reader.take(reader.integer());
    content.checkpoint.put(name, {blob.begin(), blob.end()});
  }
  return content;
}

fs::path checkpoint_path(const fs::path& folder, int increment) {
  return folder / fmt::format("checkpoint_{:04}.bin", increment);
}

/// All checkpoints of a folder, oldest first, by number.
std::map<int, fs::path> list(const fs::path& folder) {
  std::map<int, fs::path> found;
  if (!fs::is_directory(folder)) {
    return found;
  }
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    int number = 0;
    if (std::sscanf(name.c_str(), "checkpoint_%d.bin", &number) == 1 &&
        checkpoint_path(folder, number).filename() == name) {
      found[number] = entry.path();
    }
  }
  return found;
}

}  // namespace

void Checkpoint::put(const std::string& name, std::vector<std::byte> bytes) {
  late_.erase(name);
  blobs_[name] = std::move(bytes);
}

void Checkpoint::put_doubles(const std::string& name, std::span<const double> values) { put(name, bytes_of(values)); }

void Checkpoint::put_integers(const std::string& name, std::span<const std::int64_t> values) {
  put(name, bytes_of(values));
}

void Checkpoint::put_text(const std::string& name, const std::string& text) {
  put(name, bytes_of(std::span<const char>(text.data(), text.size())));
}

void Checkpoint::put_late(const std::string& name, LateBytes bytes) {
  blobs_.erase(name);
  late_[name] = std::move(bytes);
}

const std::vector<std::byte>& Checkpoint::get(const std::string& name) const {
  if (const auto later = late_.find(name); later != late_.end()) {
    std::vector<std::byte> bytes;
    bytes.reserve(later->second.size());
    later->second.write(
        [&bytes](std::span<const std::byte> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
    late_.erase(later);
    blobs_[name] = std::move(bytes);
  }
  const auto found = blobs_.find(name);
  if (found == blobs_.end()) {
    throw std::runtime_error(fmt::format("checkpoint: it has no \"{}\"", name));
  }
  return found->second;
}

std::vector<double> Checkpoint::get_doubles(const std::string& name) const {
  return values_of<double>(name, get(name));
}

std::vector<std::int64_t> Checkpoint::get_integers(const std::string& name) const {
  return values_of<std::int64_t>(name, get(name));
}

std::string Checkpoint::get_text(const std::string& name) const {
  const auto& bytes = get(name);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

CheckpointStore::CheckpointStore(std::filesystem::path folder, std::string fingerprint)
    : folder_(std::move(folder)), fingerprint_(std::move(fingerprint)) {}

std::size_t CheckpointStore::save(int increment, const Checkpoint& checkpoint) const {
  if (!fs::exists(folder_)) {
    fs::create_directory(folder_);  // not its parent: where the folder of the run has vanished, saving has to fail
  }
  HashedWriter writer(checkpoint_path(folder_, increment));
  writer.text(magic);
  writer.text(fingerprint_);
  writer.integer(checkpoint.blobs().size() + checkpoint.late().size());
  for (const auto& [name, bytes] : checkpoint.blobs()) {
    writer.text(name);
    writer.integer(bytes.size());
    writer.bytes(bytes);
  }
  for (const auto& [name, bytes] : checkpoint.late()) {
    writer.text(name);
    writer.late_bytes(name, bytes);
  }
  const std::size_t size = writer.publish();

  // Checkpoints with a higher number were written before the run was resumed from an earlier state, and are not part of
  // its history any more.
  const auto present = list(folder_);
  const auto here = present.find(increment);
  if (here == present.end()) {
    throw std::runtime_error(fmt::format("{}: vanished right after it was written; does something else change {}?",
                                         checkpoint_path(folder_, increment).string(), folder_.string()));
  }
  const int previous = here == present.begin() ? increment : std::prev(here)->first;
  for (const auto& [number, path] : present) {
    if (number != increment && number != previous) {
      fs::remove(path);
    }
  }
  return size;
}

std::optional<CheckpointStore::Loaded> CheckpointStore::load_latest() const {
  if (fs::is_directory(folder_)) {
    remove_leftovers(folder_);
  }
  const auto present = list(folder_);
  Loaded loaded;
  for (auto it = present.rbegin(); it != present.rend(); ++it) {
    Content content;
    try {
      content = read(it->second);
    } catch (const std::exception& reason) {
      loaded.skipped.push_back(fmt::format("{}: {}", it->second.string(), reason.what()));
      continue;
    }
    if (content.fingerprint != fingerprint_) {
      throw InputError(
          "--resume", it->second.string(),
          fmt::format("belongs to another case (fingerprint {}, this case has {})", content.fingerprint, fingerprint_));
    }
    loaded.increment = it->first;
    loaded.checkpoint = std::move(content.checkpoint);
    return loaded;
  }
  if (!present.empty()) {
    throw std::runtime_error(
        fmt::format("{}: no checkpoint is readable; {}", folder_.string(), loaded.skipped.front()));
  }
  return std::nullopt;
}

void CheckpointStore::clear() const {
  for (const auto& [number, path] : list(folder_)) {
    fs::remove(path);
  }
  if (fs::is_directory(folder_)) {
    remove_leftovers(folder_);
  }
}

bool holds_checkpoints(const std::filesystem::path& folder) {
  const auto present = list(folder);
  return std::any_of(present.begin(), present.end(), [](const auto& checkpoint) {
    const int file = open_regular(checkpoint.second, O_RDONLY);
    if (file < 0) {
      return false;
    }
    std::string head(magic.size(), '\0');
    const ssize_t n = ::pread(file, head.data(), head.size(), sizeof(std::uint64_t));  // behind the text's length
    ::close(file);
    return n == static_cast<ssize_t>(magic.size()) && head == magic;
  });
}

}  // namespace voussoir::io
