#pragma once
/// Checks of a run's folder before anything is written there.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "host/case/case.hpp"
#include "host/record/run_lock.hpp"

namespace voussoir::host {

struct RunOptions {
  std::filesystem::path folder;  ///< folder of the results
  bool resume = false;           ///< go on from the last checkpoint
  bool replace = false;          ///< results of an earlier run may be removed
  std::string command;           ///< command line, which the provenance repeats
  int threads = 1;
  bool take_over = false;              ///< a lock that another host left may be taken
  std::string threads_note = {};       ///< number of threads and its reason, for the log
  std::shared_ptr<RunLock> lock = {};  ///< held while the run lasts; none where nobody else can come, as in tests
};

/// Makes the folder of a run without a lock. A lock has made its own, and where that was moved since, it must not be
/// made once more.
void make_folder(const RunOptions& options);

/// To be called before something is written into the folder: RunLock::confirm, whose sentence goes to `note`, or
/// nothing where there is no lock.
void confirm_lock(const RunOptions& options, const std::function<void(const std::string&)>& note);

/// The case for which a folder is to be used, as its results repeat it.
struct CaseIdentity {
  std::string kind;         ///< a tunnel and its column share all but this
  std::string fingerprint;  ///< Case::fingerprint
  std::string resolved;     ///< Case::resolved, with which an error names the keys that differ
};

[[nodiscard]] CaseIdentity identity_of(const Case& input);

/// Throws io::InputError where the run of this case must not start: the folder holds results and neither resume nor
/// replace is asked for; it holds other files and no results; or resume is asked for and the results belong to another
/// case. A run that was killed before it had a run.h5 leaves files that are no obstacle. Where run.h5 has vanished, its
/// increments and checkpoints show that the folder holds a run. Throws std::runtime_error where such a folder's run.h5
/// cannot be read and replace is not asked for.
void check_folder(const RunOptions& options, const CaseIdentity& wanted);

/// Removes everything that a run of any kind leaves in options.folder, which check_folder has accepted before. Called
/// where options.replace is set.
void remove_earlier_run(const RunOptions& options);

}  // namespace voussoir::host
