#pragma once
/// Resources that this process takes from its machine.

namespace voussoir::host {

/// Largest resident memory of this process since its start [bytes].
[[nodiscard]] double peak_memory();

/// The memory that this process may use: that of the machine, or less where a container (cgroups, version 1 or 2) or a
/// limit of the process (`ulimit -v`) allows less [bytes].
[[nodiscard]] double memory_limit();

}  // namespace voussoir::host
