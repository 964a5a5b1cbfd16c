#pragma once
/// The time of day as files of this program state it.

#include <string>

namespace voussoir::io {

/// Now, in UTC, such as "2026-11-26T09:41:10Z".
[[nodiscard]] std::string utc_now();

}  // namespace voussoir::io
