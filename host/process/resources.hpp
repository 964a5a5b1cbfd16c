#pragma once
/// Resources that this process takes from its machine.

namespace voussoir::host {

/// Largest resident memory of this process since its start [bytes].
[[nodiscard]] double peak_memory();

}  // namespace voussoir::host
