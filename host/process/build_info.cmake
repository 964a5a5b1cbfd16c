# Writes OUTPUT, the definitions of host/process/build_info.hpp. The build runs this script before every compilation of host.
# A source archive (tools/package --source) has no git and names its revision in a file.
if(EXISTS "${SOURCE}/REVISION")
  file(STRINGS "${SOURCE}/REVISION" revision LIMIT_COUNT 1)
else()
  execute_process(COMMAND git -C "${SOURCE}" describe --always --dirty --abbrev=12
    OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(failed)
    set(revision "unknown")
  endif()
endif()
set(text "#include \"host/process/build_info.hpp\"

namespace voussoir::host {

const char* const build_version = \"${VERSION}\";
const char* const build_revision = \"${revision}\";
const char* const build_compiler = \"${COMPILER}\";
const char* const build_type = \"${BUILD_TYPE}\";

}  // namespace voussoir::host
")
set(old "")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" old)
endif()
if(NOT old STREQUAL text)
  file(WRITE "${OUTPUT}" "${text}")
endif()
