#pragma once
/// Whether the packings or the state in `packing.file` fit the case.

#include "host/case/case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

/// Compares what `packing.file` says about its origin with the case. A stored state keeps the histories of its
/// contacts, so that its soil must be this case's: throws io::InputError with the key and both values where it is not,
/// and where the file does not say its soil or has the histories of another contact law. A packing of another code
/// comes to rest anew with this case's soil; only its thickness must not differ from one that the case gives. What may
/// differ and does is said in `input.remarks`.
void check_packing_origin(const io::Table& root, Case& input);

}  // namespace voussoir::host
