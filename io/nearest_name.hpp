#pragma once
/// The name that somebody may have meant who wrote another one.

#include <string>
#include <string_view>
#include <vector>

namespace voussoir::io {

/// The last of the names that differ least from `wanted`, in letters added, left out or replaced; empty where all
/// differ in more than a third of its letters and one.
[[nodiscard]] std::string nearest_name(const std::vector<std::string>& names, std::string_view wanted);

}  // namespace voussoir::io
