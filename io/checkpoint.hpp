#pragma once
/// Checkpoints: named blobs, bit-exact, with a checksum over the whole file and the fingerprint of the resolved case.
/// The last two checkpoints are kept, so that damage by a full disk or a kill costs one increment and not the run.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace voussoir::io {

/// Bytes that are made when they are written to a file, on the thread that writes it. They save the memory and the time
/// of a copy.
struct LateBytes {
  std::function<std::size_t()> size = {};
  /// Gives `size()` bytes to `sink`, piece by piece.
  std::function<void(const std::function<void(std::span<const std::byte>)>& sink)> write = {};
};

/// The named values of one checkpoint. The functions `get...` throw std::runtime_error where the name is missing or the
/// size of its bytes is no multiple of the element's.
class Checkpoint {
 public:
  void put(const std::string& name, std::vector<std::byte> bytes);
  void put_late(const std::string& name, LateBytes bytes);
  void put_doubles(const std::string& name, std::span<const double> values);
  void put_integers(const std::string& name, std::span<const std::int64_t> values);
  void put_text(const std::string& name, const std::string& text);

  [[nodiscard]] bool has(const std::string& name) const { return blobs_.contains(name) || late_.contains(name); }
  [[nodiscard]] const std::vector<std::byte>& get(const std::string& name) const;
  [[nodiscard]] std::vector<double> get_doubles(const std::string& name) const;
  [[nodiscard]] std::vector<std::int64_t> get_integers(const std::string& name) const;
  [[nodiscard]] std::string get_text(const std::string& name) const;

  /// All values but those of LateBytes that nobody has asked for.
  [[nodiscard]] const std::map<std::string, std::vector<std::byte>>& blobs() const { return blobs_; }
  [[nodiscard]] const std::map<std::string, LateBytes>& late() const { return late_; }

 private:
  // The values themselves stay what they are where LateBytes become blobs.
  mutable std::map<std::string, std::vector<std::byte>> blobs_;
  mutable std::map<std::string, LateBytes> late_;
};

/// The checkpoints of one run: FOLDER/checkpoint_NNNN.bin, NNNN the increment after which it was taken.
class CheckpointStore {
 public:
  CheckpointStore(std::filesystem::path folder, std::string fingerprint);

  /// Writes a temporary file, syncs it and renames it; then removes all checkpoints but the last two. Throws
  /// std::runtime_error, also where the new checkpoint is gone again.
  /// @return size of the file [bytes]
  std::size_t save(int increment, const Checkpoint& checkpoint) const;

  struct Loaded {
    int increment = 0;
    Checkpoint checkpoint;
    std::vector<std::string> skipped = {};  ///< one sentence for each damaged file that was passed over
  };

  /// The newest checkpoint that is not damaged; no value where there are no files. Removes what killed writers left.
  /// Throws InputError where that
  /// checkpoint belongs to another case, std::runtime_error where files exist and all are damaged.
  [[nodiscard]] std::optional<Loaded> load_latest() const;

  /// Removes all checkpoints of the folder, because a new run starts.
  void clear() const;

 private:
  std::filesystem::path folder_;
  std::string fingerprint_;
};

/// True where a file of the folder has the name of a checkpoint and begins as one; whether it is whole is not looked
/// at.
[[nodiscard]] bool holds_checkpoints(const std::filesystem::path& folder);

}  // namespace voussoir::io
