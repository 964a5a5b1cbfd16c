#pragma once
/// A sweep file: which runs it asks for, by which names, with which cases and overrides.
/// docs/how-to/sweep_on_a_cluster.md describes the file.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/key_info.hpp"

namespace voussoir::host {

struct PlannedRun {
  std::string name;                 ///< its folder below the sweep's: "tunnels/cover_ratio_2/member_000"
  std::filesystem::path case_file;  ///< the case that it runs
  std::vector<std::string> overrides;
  std::string grid;   ///< name of its grid; empty where the grid has none, and for [[run]]
  std::string point;  ///< folder of its point below the sweep's; its name where it is alone there
  std::vector<std::pair<std::string, std::string>> axes;  ///< name and value
  std::string place;                                      ///< where the file asks for it, "sweep.toml:12"
};

/// A point of a grid with several members, which are reduced to an ensemble in its folder.
struct PlannedEnsemble {
  std::string name;  ///< its folder below the sweep's
  std::filesystem::path case_file;
  std::vector<std::string> overrides;  ///< those that all members have
  std::vector<std::size_t> runs;       ///< its members among the runs of the plan
};

struct SweepPlan {
  std::filesystem::path file;
  std::string text;  ///< the file itself, for the results
  std::vector<PlannedRun> runs;
  std::vector<PlannedEnsemble> ensembles;
};

/// Reads a sweep file. The cases themselves are read only where members have to draw different seeds. Throws
/// io::InputError for whatever the file says wrong: names, axes of different lengths that advance together, two runs of
/// one name, no run at all.
[[nodiscard]] SweepPlan load_sweep(const std::filesystem::path& file);

/// All keys of sweep files. A key whose name the user chooses ends in a placeholder.
[[nodiscard]] io::KeyList keys_of_sweep();

/// The run of this name; throws io::InputError where there is none.
[[nodiscard]] const PlannedRun& run_named(const SweepPlan& plan, const std::string& name);

/// Where the outcome of a run is kept (io/outcome_file.hpp): DIR/outcomes/NAME.json with "__" for each "/".
[[nodiscard]] std::filesystem::path outcome_path(const std::filesystem::path& folder, const std::string& run);

}  // namespace voussoir::host
