#include "host/record/folder.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "host/case/load_case.hpp"
#include "io/atomic_file.hpp"
#include "io/case_compare.hpp"
#include "io/checkpoint.hpp"
#include "io/increment_file.hpp"
#include "io/input_error.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

/// Names that a run may leave before it has a run.h5, besides its lock, which this process holds.
constexpr std::array<std::string_view, 4> first_names{"run.log", "increments", "checkpoints", "column"};
/// Further names that it may leave. run.h5 is removed last: while it exists, the folder is known as a folder of
/// results.
constexpr std::array<std::string_view, 5> further_names{"result.xdmf", "k0.csv", "path.csv", "probe.csv", "run.h5"};

/// True for an entry that a run leaves when it is killed before it has a run.h5.
bool is_left_by_a_start(const std::filesystem::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  return entry.path().extension() == ".tmp" || name == run_lock_name ||
         std::find(first_names.begin(), first_names.end(), name) != first_names.end();
}

bool is_left_by_a_probe(const std::filesystem::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  const bool is_end = name.starts_with("end_") && entry.path().extension() == ".h5";
  return name == "probe.csv" || name == "path.csv" || is_end || is_left_by_a_start(entry);
}

/// True where a file of the folder shows by its content that a run of this program wrote there, whatever has become of
/// run.h5.
bool holds_increments_or_checkpoints(const std::filesystem::path& folder) {
  const std::vector<int> increments = io::list_increments(folder);
  const bool any = std::any_of(increments.begin(), increments.end(),
                               [&](int index) { return io::is_increment_file(io::increment_path(folder, index)); });
  return any || io::holds_checkpoints(folder / "checkpoints");
}

/// True where all that lies in the folder has a name that a run gives, and the folder of the increments is there.
bool looks_like_a_run(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const auto known = [](const fs::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return is_left_by_a_probe(entry) ||
           std::find(further_names.begin(), further_names.end(), name) != further_names.end();
  };
  return fs::is_directory(folder / "increments") &&
         std::all_of(fs::directory_iterator(folder), fs::directory_iterator(), known);
}

/// check_folder of a folder without run.h5.
void check_without_index(const RunOptions& options) {
  namespace fs = std::filesystem;
  const std::string folder = options.folder.string();
  const bool has_probe = fs::exists(options.folder / "probe.csv");
  const bool results = holds_increments_or_checkpoints(options.folder);
  const bool ours = results ||
                    std::all_of(fs::directory_iterator(options.folder), fs::directory_iterator(), is_left_by_a_probe);
  if (!ours) {
    throw io::InputError("--output", folder, "holds files that are no results of this program; choose another folder");
  }
  if (options.replace) return;
  if (has_probe && !results) {
    throw io::InputError("--output", folder, "holds a probe, which has nothing to resume: add --replace to remove it");
  }
  if (!results) return;  // a probe that has failed may have left the ends of its paths without probe.csv
  const bool can_go_on = io::holds_checkpoints(options.folder / "checkpoints");
  if (options.resume && can_go_on) return;
  throw io::InputError(
      options.resume ? "--resume" : "--output", folder,
      std::string("holds results already, whose run.h5 is missing: ") +
          (can_go_on ? "add --resume to go on, which makes it anew, or --replace to remove the results"
                     : "there is no checkpoint from which the run could go on; add --replace to remove the results"));
}

/// check_folder of a folder whose run.h5 cannot be read.
void check_damaged_index(const RunOptions& options, const std::string& reason) {
  const std::string folder = options.folder.string();
  if (!holds_increments_or_checkpoints(options.folder) && !looks_like_a_run(options.folder)) {
    throw io::InputError("--output", folder,
                         "its run.h5 cannot be used, and no other file there is of this program: " + reason);
  }
  if (options.replace) return;
  const bool can_go_on = io::holds_checkpoints(options.folder / "checkpoints");
  throw std::runtime_error(folder + ": its run.h5 cannot be used: " + reason + "; " +
                           (can_go_on ? "where that file is removed, --resume makes it anew and goes on; " : "") +
                           "--replace removes the whole run");
}

/// A sentence that names the keys in which a run's case and this case differ.
std::string difference(const io::Provenance& theirs, const CaseIdentity& wanted) {
  std::string otherwise = "all keys agree, but the fingerprint is " + theirs.fingerprint + " and not " +
                          wanted.fingerprint + ": the files of packing.file, or the program, have changed";
  try {
    const std::vector<io::KeyDifference> keys = io::differences(wanted.resolved, theirs.input, keys_without_results);
    return keys.empty() ? otherwise : io::describe(keys, "the run");
  } catch (const std::runtime_error&) {  // the file is from elsewhere
    return otherwise;
  }
}

}  // namespace

void make_folder(const RunOptions& options) {
  if (!options.lock) std::filesystem::create_directories(options.folder);
}

void confirm_lock(const RunOptions& options, const std::function<void(const std::string&)>& note) {
  const std::string changed = options.lock ? options.lock->confirm() : std::string();
  if (!changed.empty()) note(changed);
}

CaseIdentity identity_of(const Case& input) { return {to_string(input.kind), input.fingerprint, input.resolved}; }

void check_folder(const RunOptions& options, const CaseIdentity& wanted) {
  namespace fs = std::filesystem;
  const std::string folder = options.folder.string();
  if (!fs::exists(options.folder)) return;
  if (!fs::is_directory(options.folder)) throw io::InputError("--output", folder, "is not a folder");
  if (!fs::exists(options.folder / "run.h5")) {
    check_without_index(options);
    return;
  }
  io::Provenance theirs;
  try {
    theirs = io::read_provenance(options.folder / "run.h5");
  } catch (const std::runtime_error& error) {
    check_damaged_index(options, error.what());
    return;
  }
  if (options.resume) {
    if (theirs.case_kind != wanted.kind) {
      throw io::InputError("--resume", folder,
                           "holds results of the kind " + theirs.case_kind + ", but this case is a " + wanted.kind);
    }
    if (theirs.fingerprint == wanted.fingerprint) return;
    throw io::InputError("--resume", folder,
                         "was made by another case: " + difference(theirs, wanted) +
                             "; resume needs the same case file and --set values");
  }
  if (!options.replace) {
    throw io::InputError("--output", folder,
                         "holds results already: add --resume to go on or --replace to remove them");
  }
}

void remove_earlier_run(const RunOptions& options) {
  namespace fs = std::filesystem;
  if (!fs::exists(options.folder / "run.h5") && !fs::exists(options.folder / "probe.csv") &&
      !holds_increments_or_checkpoints(options.folder))
    return;  // the next run overwrites the files that such a start left
  for (const std::string_view name : first_names) fs::remove_all(options.folder / name);
  if (fs::exists(options.folder / "probe.csv")) {
    std::vector<fs::path> ends;
    for (const auto& entry : fs::directory_iterator(options.folder)) {
      if (is_left_by_a_probe(entry) && entry.path().extension() == ".h5") ends.push_back(entry.path());
    }
    for (const fs::path& end : ends) fs::remove(end);
  }
  for (const std::string_view name : further_names) fs::remove(options.folder / name);
  io::remove_leftovers(options.folder);
}

}  // namespace voussoir::host
