#include "host/run_folder.hpp"

#include <algorithm>
#include <stdexcept>

#include "io/case_file.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

/// Fingerprint of the case that made the results; throws io::InputError where run.h5 is no result of this program.
std::string fingerprint_of_results(const RunOptions& options) {
  try {
    return io::read_provenance(options.folder / "run.h5").fingerprint;
  } catch (const std::runtime_error& error) {
    throw io::InputError("--output", options.folder.string(), std::string("its run.h5 cannot be used: ") + error.what());
  }
}

}  // namespace

void check_folder(const RunOptions& options, const Case& input) {
  namespace fs = std::filesystem;
  const std::string folder = options.folder.string();
  if (!fs::exists(options.folder)) return;
  if (!fs::is_directory(options.folder)) throw io::InputError("--output", folder, "is not a folder");
  if (!fs::exists(options.folder / "run.h5")) {
    // A run killed in its first moment leaves a log and nothing else.
    const bool only_log = std::all_of(fs::directory_iterator(options.folder), fs::directory_iterator(),
                                      [](const fs::directory_entry& e) { return e.path().filename() == "run.log"; });
    if (only_log) return;
    throw io::InputError("--output", folder, "holds files that are no results of this program; choose another folder");
  }
  const std::string theirs = fingerprint_of_results(options);
  if (options.resume) {
    if (theirs == input.fingerprint) return;
    throw io::InputError("--resume", folder,
                         "was made by another case (fingerprint " + theirs + ", this case has " + input.fingerprint +
                             "): resume needs the same case file and --set values");
  }
  if (!options.replace) {
    throw io::InputError("--output", folder, "holds results already: add --resume to go on or --replace to remove them");
  }
}

}  // namespace voussoir::host
