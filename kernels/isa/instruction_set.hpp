#pragma once
/// The instruction sets for which the lanes are compiled, and the processor's own.

#include <string>

namespace voussoir::kernels {

/// `scalar` runs on every processor of the build's architecture, on x86-64 on its baseline. `v3` and `v4` are the
/// levels of x86-64 of its psABI: AVX2 with fused operations, and AVX-512.
enum class InstructionSet { scalar, v3, v4 };

/// The name that the key engine.isa has for a set.
[[nodiscard]] const char* name_of(InstructionSet isa);

/// A set in words, such as "v4 (x86-64-v4, AVX-512)".
[[nodiscard]] const char* description_of(InstructionSet isa);

/// The largest set that the processor and the operating system offer.
[[nodiscard]] InstructionSet processor_set();

/// The processor's name as it tells it itself; "unknown" where it tells none.
[[nodiscard]] std::string processor_name();

}  // namespace voussoir::kernels
