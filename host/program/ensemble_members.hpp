#pragma once
/// The members of an ensemble after their runs: which of them count, and their reduction to means and bands. Commands
/// `ensemble` and `sweep` share it.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "host/ensemble/member.hpp"
#include "host/program/ensemble_goal.hpp"
#include "host/program/run_processes.hpp"
#include "host/program/run_rows.hpp"
#include "host/record/run_lock.hpp"

namespace voussoir::host {

struct EnsembleMembers {
  Case input;                     ///< the case with the seed of the first member
  std::filesystem::path folder;   ///< of the ensemble
  std::string command;            ///< command line, which the provenance repeats
  std::string point = {};         ///< its point of a sweep, which sentences on standard error begin with
  std::optional<Goal> goal = {};  ///< of --until
  std::vector<ProcessRun> runs = {};
  std::vector<io::SweepRow> rows = {};       ///< (run) of summary.csv
  std::vector<std::size_t> numbers = {};     ///< (run) which member it is; members that were not run are left out
  std::vector<bool> reduced = {};            ///< (run) its results are among `finished`
  std::vector<MemberResults> finished = {};  ///< in the order of the runs
};

/// The run of a member, with its own seed, in its folder.
[[nodiscard]] ProcessRun member_run(const EnsembleMembers& ensemble, const std::filesystem::path& case_file,
                                    const std::vector<std::string>& overrides, std::size_t member);

/// Adds the run of a member that has ended, with what was read of it. Its results count if it came to its end.
void add_member(EnsembleMembers& ensemble, ProcessRun run, std::size_t member, ReadRun read);

/// Writes summary.csv with one row for each run.
void write_summary(const EnsembleMembers& ensemble);

/// Names the members that did not end well and writes ensemble.h5, fields/, curves.csv and members.csv in place of an
/// earlier reduction's. `error` is the standard error that --until reached. Returns the outcome of the ensemble but for
/// its goal: that of its runs, or interrupted where a request to stop ended the reduction.
/// Throws std::runtime_error where a member that is done has no results.
[[nodiscard]] Outcome reduce_members(const EnsembleMembers& ensemble, std::optional<double> error, const RunLock& lock);

}  // namespace voussoir::host
