#pragma once
/// The record of one run in one folder: result files, checkpoints, log and progress. It knows nothing of what is
/// computed.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "fem/newton.hpp"
#include "host/case/case.hpp"
#include "host/record/folder.hpp"
#include "host/record/log.hpp"
#include "host/record/totals.hpp"
#include "io/checkpoint.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {

class RunRecorder {
 public:
  /// Starts the results in options.folder, or goes on behind the last checkpoint there when options.resume is set and
  /// one exists. `kind` names the run in its provenance, which stays that of the start when a run goes on. Nothing is
  /// written to a finished run before it is asked for. Throws std::runtime_error naming the file that cannot be used.
  RunRecorder(const RunOptions& options, const Case& input, const std::string& kind, io::MeshData mesh, RunLog& log);

  [[nodiscard]] bool finished() const { return finished_; }  ///< an earlier run has done everything
  [[nodiscard]] const io::Checkpoint* resumed() const;       ///< what to go on from; nullptr at a start
  [[nodiscard]] const std::string& resumed_stage() const { return resumed_stage_; }  ///< empty at a start
  [[nodiscard]] int resumed_stage_index() const { return resumed_stage_index_; }
  [[nodiscard]] RunLog& log() { return log_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// What the stages have cost so far; those of a resumed run include what came before.
  [[nodiscard]] const std::vector<StageTotals>& totals() const { return totals_; }
  /// Totals of the stage that was begun last.
  [[nodiscard]] StageTotals& stage_totals() { return totals_.back(); }

  /// Progress: a stage of `planned` increments, of which `done` are behind it.
  void begin_stage(const std::string& name, int done, int planned);
  void show_iterate(double load_parameter, const fem::Iterate& iterate);
  /// One line about a finished increment, in the log and on the terminal.
  void report(const io::IncrementInfo& info);

  /// "12 result files of 0.9 MB, checkpoint of 145 MB": written by this process.
  [[nodiscard]] std::string disk_use() const;

  /// Writes a result file; `info.index` is set here.
  void write(io::IncrementInfo info, const std::vector<io::Field>& fields,
             const std::vector<io::RveSnapshot>& snapshots, const std::vector<double>& coordinates);

  /// A table of run.h5, see io::ResultWriter::set_table. A finished run that has a table of this name keeps it.
  void set_table(const std::string& name, std::vector<io::TableColumn> columns);

  /// Saves a checkpoint after increment `stage_index` of `stage`; `finished`: nothing is left to do behind it.
  void save(io::Checkpoint checkpoint, const std::string& stage, int stage_index, bool finished);

 private:
  [[nodiscard]] std::string time_left(int done) const;

  std::filesystem::path folder_;
  RunLog& log_;
  io::CheckpointStore store_;
  std::optional<io::CheckpointStore::Loaded> loaded_;
  io::Provenance provenance_;
  io::MeshData mesh_;
  std::optional<io::ResultWriter> writer_;  ///< none as long as a finished run needs nothing
  std::string resumed_stage_;
  int resumed_stage_index_ = 0;
  bool finished_ = false;
  int sequence_ = 0;             ///< checkpoints so far
  int result_index_ = 0;         ///< last result file
  int files_ = 0;                ///< result files written by this process
  double file_bytes_ = 0;        ///< of all of them
  double checkpoint_bytes_ = 0;  ///< of the last one
  std::vector<StageTotals> totals_;
  std::string stage_;
  int stage_done_ = 0;     ///< increments of the stage behind the start of this process
  int stage_current_ = 0;  ///< increments of the stage done
  int stage_planned_ = 0;
  std::chrono::steady_clock::time_point stage_start_;
};

}  // namespace voussoir::host
