#pragma once
/// Files that exist completely or not at all: write under `temporary_name`, then `publish`.

#include <filesystem>
#include <string>

namespace voussoir::io {

/// The name beside `target` under which to write, TARGET.PID.tmp, so that processes that write the same file do not
/// disturb one another. Leftovers of a killed writer are ignored by every reader here.
[[nodiscard]] std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Syncs the closed temporary file to the disk, renames it to `target`, syncs the folder.
/// Throws std::runtime_error naming the file.
void publish(const std::filesystem::path& target);

/// Writes text through temporary_name and publish.
void write_text(const std::filesystem::path& target, const std::string& text);

/// Removes the files that killed writers left in `folder`: those that end in ".tmp", except files of other processes
/// that still run.
void remove_leftovers(const std::filesystem::path& folder);

}  // namespace voussoir::io
