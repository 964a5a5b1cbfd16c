#pragma once
/// The one way by which the program opens files that lie in its folders and that a user, or another program, may have
/// replaced. A pipe in place of a file would be waited for without end, and a device might answer without end.

#include <cstddef>
#include <filesystem>
#include <vector>

namespace voussoir::io {

/// Opens a regular file by open(2) and never waits. Returns the descriptor, or -1 with the reason in errno: EISDIR for
/// a folder and ENXIO for a pipe, a socket or a device. `flags` are completed by O_CLOEXEC.
[[nodiscard]] int open_regular(const std::filesystem::path& path, int flags);

/// All bytes of a regular file. Throws std::runtime_error with the reason, without the name of the file.
[[nodiscard]] std::vector<std::byte> read_regular(const std::filesystem::path& path);

}  // namespace voussoir::io
