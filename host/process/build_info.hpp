#pragma once
/// The sources and the compiler of this program, as every result file tells them. build_info.cmake writes the values.

namespace voussoir::host {

extern const char* const build_version;
extern const char* const build_revision;  ///< as git describe says it, with "-dirty" where the tree had changes
extern const char* const build_compiler;
extern const char* const build_type;

}  // namespace voussoir::host
