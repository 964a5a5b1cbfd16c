#pragma once
/// The commands, called after the command line is parsed. They return outcomes and throw input errors.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/process/exit_code.hpp"
#include "host/program/run_processes.hpp"
#include "host/record/folder.hpp"

namespace voussoir::host {

/// `voussoir run`: checks case and folder before anything is written. Kokkos is initialised for the time of the run,
/// with options.threads (process/threads.hpp); 0 asks for the default. The folder is locked for the time of the run.
[[nodiscard]] Outcome command_run(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                                  RunOptions options);

/// `voussoir check`: prints every value after defaults and overrides, and the estimated cost of the run.
[[nodiscard]] Outcome command_check(const std::filesystem::path& case_file, const std::vector<std::string>& overrides);

/// `voussoir mesh`: generates the mesh of a tunnel and writes it into a file for ground.mesh_file. A file that is there
/// is overwritten only where `replace` says so.
[[nodiscard]] Outcome command_mesh(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                                   const std::filesystem::path& target, bool replace);

/// What `voussoir keys` prints: comma-separated values, a page in Markdown, or a JSON schema.
enum class KeyForm { table, page, schema };

/// `voussoir keys`: prints all keys of a kind of case, of sweep files ("sweep"), of a table ("soil") or of all, or one
/// key ("soil.thickness"), with their types, defaults, limits and explanations. Throws io::InputError for other names.
[[nodiscard]] Outcome command_keys(const std::optional<std::string>& name, KeyForm form);

/// `voussoir info`: prints where a result comes from, and its table of increments.
[[nodiscard]] Outcome command_info(const std::filesystem::path& result_file);

/// `voussoir info --cpu`: prints the processor, the sets of lanes in this program, and which of them is taken and why.
[[nodiscard]] Outcome command_info_cpu();
[[nodiscard]] Outcome command_info_devices();

/// What `voussoir sweep` is asked to do with the runs of its file.
enum class SweepTask { run_all, list, run_one, gather };

struct SweepOptions {
  std::filesystem::path folder;
  ProcessOptions runs;
  SweepTask task = SweepTask::run_all;
  std::string only = {};     ///< name of the run, for SweepTask::run_one
  bool json = false;         ///< the list is JSON (io/run_list.hpp)
  std::string command = {};  ///< command line, which the provenance of ensembles repeats
};

/// `voussoir sweep`: runs the cases that a sweep file asks for, each in a folder of its own, and gathers summary.csv,
/// sweep.h5 and the means of members; or lists its runs, runs one of them, or gathers what other programs have run.
[[nodiscard]] Outcome command_sweep(const std::filesystem::path& sweep_file, const SweepOptions& options);

struct EnsembleOptions {
  std::filesystem::path folder;
  ProcessOptions runs;
  std::vector<std::string> overrides;
  std::optional<int> members;  ///< their number, with `until` the largest number
  std::string until;           ///< wanted share of the standard error, such as "5 %"; empty: a given number of members
  std::string result;          ///< column of which `until` speaks; empty: the kind's default
  std::string command;         ///< command line, which the provenance repeats
};

/// `voussoir ensemble`: runs one case several times with different draws of its packings, and reduces the results to
/// means and bands.
[[nodiscard]] Outcome command_ensemble(const std::filesystem::path& case_file, const EnsembleOptions& options);

}  // namespace voussoir::host
