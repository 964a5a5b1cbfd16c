#pragma once
/// The record of one run in one folder: result files, checkpoints, log lines and progress. The recorder does not know
/// how the results are computed.
///
/// The files of an increment are written by a thread of their own while the next increment is computed. All files and
/// the log are otherwise used by the calling thread alone, which waits for the other one first.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "fem/newton.hpp"
#include "host/record/folder.hpp"
#include "host/record/increment_report.hpp"
#include "host/record/log.hpp"
#include "host/record/totals.hpp"
#include "host/record/writer.hpp"
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

  // A failure of the files that are written is thrown by whichever of the next functions is called first.

  /// Tells the progress display that a stage of `planned` increments begins or goes on behind its increment `done`.
  void begin_stage(const std::string& name, int done, int planned);
  void show_iterate(double load_parameter, const fem::Iterate& iterate);

  /// Takes a result file that hand_over writes, and gives the increment its index.
  void add_file(const IncrementReport& increment, std::vector<io::Field> fields, std::vector<io::RveSnapshot> snapshots,
                std::vector<double> coordinates);
  /// Takes a checkpoint after increment `stage_index` of `stage` that hand_over writes. `finished` says that the whole
  /// run ends there.
  void add_checkpoint(io::Checkpoint checkpoint, const std::string& stage, int stage_index, bool finished);
  /// Takes one line about a finished increment, which the log and the terminal get when its files are on the disk.
  void add_line(const IncrementReport& increment);
  /// Begins to write what was taken, after what was handed over before is on the disk.
  void hand_over();
  /// Waits until everything that was handed over is on the disk, and tells of it.
  void finish();

  /// The files that this process has written, such as "12 result files of 0.9 MB, checkpoint of 145 MB".
  [[nodiscard]] std::string disk_use() const;

  /// Writes a table of run.h5 before it returns, see io::ResultWriter::set_table. A finished run that has a table of
  /// this name keeps it.
  void set_table(const std::string& name, std::vector<io::TableColumn> columns);

 private:
  /// The output of one increment.
  struct Output {
    struct File {
      io::IncrementInfo row;
      std::vector<io::Field> fields;
      std::vector<io::RveSnapshot> snapshots;
      std::vector<double> coordinates;
    };
    std::optional<File> file;
    std::optional<io::Checkpoint> checkpoint;
    int sequence = 0;  ///< number of the checkpoint
    std::string line;  ///< empty: none

    // What its writing has found.
    std::vector<std::string> warnings;
    double file_bytes = 0;
    double checkpoint_bytes = 0;
    WriterTime time;
  };

  [[nodiscard]] std::string time_left(int done) const;
  /// Makes sure that the folder still belongs to this run.
  void confirm();
  void put_on_disk(Output& output);
  void tell(const Output& output);

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
  Output next_;                  ///< of the present increment
  std::optional<Output> given_;  ///< to the thread that writes, whose it is until that thread is idle
  Writer thread_;                ///< destroyed first, because its job uses the other members
};

}  // namespace voussoir::host
