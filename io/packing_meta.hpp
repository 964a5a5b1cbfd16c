#pragma once
/// The file NAME_meta.json beside the grains of another code. Private to io.

#include <string>

#include "io/packing_file.hpp"

namespace voussoir::io {

/// Takes cell, thickness, numbers and labels from the text of a meta file. Returns a sentence about the first fault,
/// which names the key; empty without one.
[[nodiscard]] std::string take_packing_meta(const std::string& text, Packing& packing);

}  // namespace voussoir::io
