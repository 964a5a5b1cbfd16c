#pragma once
/// The keys of case files with the kinds that use them, for `voussoir keys`.

#include "host/case/case.hpp"
#include "io/key_reference.hpp"

namespace voussoir::host {

/// The keys of one kind.
[[nodiscard]] io::KeyReference case_reference(CaseKind kind);
/// The keys of all kinds.
[[nodiscard]] io::KeyReference case_reference();

}  // namespace voussoir::host
