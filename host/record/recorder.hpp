#pragma once
/// The record of one run in one folder: result files, checkpoints, log lines and progress. The recorder does not know
/// how the results are computed.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "fem/newton.hpp"
#include "host/record/folder.hpp"
#include "host/record/increment_report.hpp"
#include "host/record/log.hpp"
#include "host/record/totals.hpp"
#include "io/checkpoint.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {

class RunRecorder {
 public:
  /// Starts the results in options.folder, or goes on behind the last checkpoint there when options.resume is set and
  /// a checkpoint exists. A run that goes on keeps the provenance of its start. A finished run stays untouched until
  /// set_table asks for a table that it lacks. Throws std::runtime_error naming the file that cannot be used.
  RunRecorder(const RunOptions& options, const io::Provenance& provenance, io::MeshData mesh, RunLog& log);

  [[nodiscard]] bool finished() const { return finished_; }  ///< an earlier process has finished this run
  /// Throws std::runtime_error where result files of a finished run are missing, damaged or those of another run.
  void require_all_files() const;
  [[nodiscard]] const io::Checkpoint* resumed() const;  ///< the checkpoint to go on from; nullptr at a start
  [[nodiscard]] const std::string& resumed_stage() const { return resumed_stage_; }  ///< empty at a start
  [[nodiscard]] int resumed_stage_index() const { return resumed_stage_index_; }
  [[nodiscard]] RunLog& log() { return log_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// The costs of the stages so far. A resumed run includes the costs of the processes before this one.
  [[nodiscard]] const std::vector<StageTotals>& totals() const { return totals_; }
  /// The totals of the stage that was begun last.
  [[nodiscard]] StageTotals& stage_totals() { return totals_.back(); }

  /// Tells the progress display that a stage of `planned` increments begins or goes on behind its increment `done`.
  void begin_stage(const std::string& name, int done, int planned);
  void show_iterate(double load_parameter, const fem::Iterate& iterate);
  /// Writes one line about a finished increment to the log and to the terminal.
  void report(const IncrementReport& increment);

  /// The files that this process has written, such as "12 result files of 0.9 MB, checkpoint of 145 MB".
  [[nodiscard]] std::string disk_use() const;

  /// Writes a result file and gives the increment its index.
  void write(const IncrementReport& increment, const std::vector<io::Field>& fields,
             const std::vector<io::RveSnapshot>& snapshots, const std::vector<double>& coordinates);

  /// Writes a table of run.h5, see io::ResultWriter::set_table. A finished run that has a table of this name keeps it.
  void set_table(const std::string& name, std::vector<io::TableColumn> columns);

  /// Saves a checkpoint after increment `stage_index` of `stage`. `finished` says that the whole run ends there.
  void save(io::Checkpoint checkpoint, const std::string& stage, int stage_index, bool finished);

 private:
  [[nodiscard]] std::string time_left(int done) const;
  /// Makes sure that the folder still belongs to this run.
  void confirm();

  RunOptions options_;
  std::filesystem::path folder_;
  RunLog& log_;
  io::CheckpointStore store_;
  std::optional<io::CheckpointStore::Loaded> loaded_;
  io::Provenance provenance_;
  io::MeshData mesh_;
  std::optional<io::ResultWriter> writer_;  ///< none as long as nothing is written to a finished run
  std::string resumed_stage_;
  int resumed_stage_index_ = 0;
  bool finished_ = false;
  int sequence_ = 0;             ///< number of the last checkpoint
  int result_index_ = 0;         ///< number of the last result file
  int files_ = 0;                ///< result files written by this process
  double file_bytes_ = 0;        ///< size of these files together
  double checkpoint_bytes_ = 0;  ///< size of the last checkpoint
  std::vector<StageTotals> totals_;
  std::string stage_;
  int stage_done_ = 0;     ///< increments of the stage that were done before this process began
  int stage_current_ = 0;  ///< increments of the stage done
  int stage_planned_ = 0;
  std::chrono::steady_clock::time_point stage_start_;
};

}  // namespace voussoir::host
