#pragma once
/// What this program was built from; written into every result file. Defined by build_info.cmake.

namespace voussoir::host {

extern const char* const build_version;
extern const char* const build_revision;  ///< git describe, "-dirty" where the tree had changes
extern const char* const build_compiler;
extern const char* const build_type;

}  // namespace voussoir::host
