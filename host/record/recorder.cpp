#include "host/record/recorder.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "host/record/remarks.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

std::string duration(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

/// Remarks for the log about an increment, in addition to its residual.
std::string remarks(const EquilibriumReport& found) {
  std::string text;
  if (found.relaxations > 0) text += fmt::format(", relaxed in {} substeps", found.relaxations);
  if (found.open_points > 0) text += fmt::format(", {} RVEs without contacts", found.open_points);
  if (found.step_limit_points > 0) text += fmt::format(", {} RVEs at the step limit", found.step_limit_points);
  if (found.step_limit_points > 0 && found.unsettled > 1) {
    text += fmt::format(": not converged, because they may put the residual off by {:.2g} of its tolerance",
                        found.unsettled);
  }
  if (const auto beyond = found.out_of_range_points.value_or(0); beyond > 0) {
    text += fmt::format(", {} RVEs beyond the contact law's range", beyond);
  }
  if (const auto deferred = found.deferred_points.value_or(0); deferred > 0) {
    text += fmt::format(", {} RVEs deferred", deferred);
  }
  if (const double error = found.deferral_error.value_or(0); error > 0) {
    text += fmt::format(", deferred answers were off by up to {:.1e} of the pressure", error);
  }
  if (found.slowest_point && found.slowest_steps) {
    text += fmt::format(", the slowest RVE was {} with {} steps", *found.slowest_point, *found.slowest_steps);
  }
  return text;
}

/// Throws where a checkpoint is one of another kind of run, as a tunnel's and its column's, which share the
/// fingerprint.
void expect_kind(const io::Checkpoint& checkpoint, const std::string& kind, const std::filesystem::path& folder) {
  const bool told = checkpoint.blobs().contains("kind");
  // Checkpoints of older versions do not tell it; there run.h5 does.
  if (!told && std::filesystem::exists(folder / "run.h5")) return;
  const std::string theirs = told ? checkpoint.get_text("kind") : "that no file tells";
  if (theirs == kind) return;
  throw io::InputError("--resume", folder.string(),
                       "holds a checkpoint of the kind " + theirs + ", but this case is a " + kind);
}

io::Provenance provenance_in(const std::filesystem::path& file) {
  try {
    return io::read_provenance(file);
  } catch (const std::runtime_error& damage) {
    throw std::runtime_error(std::string(damage.what()) +
                             "; where that file is removed, --resume makes it anew and goes on");
  }
}

}  // namespace

RunRecorder::RunRecorder(const RunOptions& options, const io::Provenance& provenance, io::MeshData mesh, RunLog& log)
    : options_(options),
      folder_(options.folder),
      log_(log),
      store_(options.folder / "checkpoints", provenance.fingerprint),
      provenance_(provenance),
      mesh_(std::move(mesh)) {
  if (options.resume) loaded_ = store_.load_latest();
  if (!loaded_) {
    store_.clear();
    writer_ = io::ResultWriter::create(folder_, provenance_, mesh_);
    return;
  }
  for (const std::string& skipped : loaded_->skipped) log_.warning(skipped);
  const io::Checkpoint& checkpoint = loaded_->checkpoint;
  const std::vector<std::int64_t> record = checkpoint.get_integers("record");
  resumed_stage_ = checkpoint.get_text("stage");
  resumed_stage_index_ = static_cast<int>(record.at(0));
  result_index_ = static_cast<int>(record.at(1));
  finished_ = record.at(2) != 0;
  sequence_ = loaded_->increment;
  totals_ = totals_from(checkpoint);
  expect_kind(checkpoint, provenance.case_kind, folder_);
  const bool indexed = std::filesystem::exists(folder_ / "run.h5");
  if (indexed) provenance_ = provenance_in(folder_ / "run.h5");
  if (!indexed)
    log_.warning(
        fmt::format("{} has vanished; it is made anew from the increments, and tables that the run wrote "
                    "before its checkpoint may be missing in it",
                    (folder_ / "run.h5").string()));
  for (const std::string& line : resume_differences(provenance_, provenance)) log_.line(line);
  const bool whole = finished_ && indexed;
  if (!whole) writer_ = io::ResultWriter::resume(folder_, provenance_, mesh_, result_index_);
  // The files of a finished run are read, too: there is nothing to do only where they are there and not damaged.
  const auto present = static_cast<int>(writer_ ? writer_->increments().size()
                                                : io::read_increments(folder_ / "run.h5").size());
  if (present < result_index_) {
    log_.warning(fmt::format("{} of the {} result files that the run had written have vanished from {}{}",
                             result_index_ - present, result_index_, (folder_ / "increments").string(),
                             finished_ ? "; --replace computes them anew" : "; it goes on without them"));
  }
}

void RunRecorder::require_all_files() const {
  const std::vector<io::IncrementInfo> present = io::read_increments(folder_ / "run.h5");
  if (static_cast<int>(present.size()) == result_index_) return;
  throw std::runtime_error(fmt::format(
      "{}: the last checkpoint says that the run is finished and has written {} result files, but there are "
      "{}: put the files back, or begin anew with --replace",
      (folder_ / "increments").string(), result_index_, present.size()));
}

void RunRecorder::confirm() {
  confirm_lock(options_, [this](const std::string& changed) { log_.warning(changed); });
}

const io::Checkpoint* RunRecorder::resumed() const { return loaded_ ? &loaded_->checkpoint : nullptr; }

void RunRecorder::begin_stage(const std::string& name, int done, int planned) {
  stage_ = name;
  if (totals_.empty() || totals_.back().stage != name) totals_.emplace_back().stage = name;
  stage_done_ = done;
  stage_current_ = done;
  stage_planned_ = planned;
  stage_start_ = std::chrono::steady_clock::now();
}

std::string RunRecorder::time_left(int done) const {
  const int here = done - stage_done_;
  if (here <= 0) return "?";
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - stage_start_;
  return duration(spent.count() / here * (stage_planned_ - done));
}

void RunRecorder::show_iterate(double load_parameter, const fem::Iterate& iterate) {
  if (given_ && thread_.idle()) finish();
  log_.live(fmt::format("{} {}/{}  at {:.4g}  iteration {}  residual {:.2e} of {:.2e} N/m  the stage ends in {}",
                        stage_, stage_current_ + 1, stage_planned_, load_parameter, iterate.iteration, iterate.residual,
                        iterate.bound, time_left(stage_current_)));
}

void RunRecorder::add_line(const IncrementReport& increment) {
  const io::IncrementInfo& info = increment.info;
  stage_current_ = info.stage_index;
  std::string text = fmt::format("{} {}/{}: at {:.5g}, {} iterations, residual {:.1e}, {:.2g} s", info.stage,
                                 info.stage_index, stage_planned_, info.load_parameter, info.iterations, info.residual,
                                 info.wall_s);
  if (info.cuts > 0) text += fmt::format(", the step was cut {} times", info.cuts);
  if (increment.equilibrium) text += remarks(*increment.equilibrium);
  if (stage_current_ < stage_planned_) text += fmt::format("; the stage ends in {}", time_left(stage_current_));
  next_.line = std::move(text);
}

void RunRecorder::add_file(const IncrementReport& increment, std::vector<io::Field> fields,
                           std::vector<io::RveSnapshot> snapshots, std::vector<double> coordinates) {
  io::IncrementInfo row = row_of(increment);
  row.index = ++result_index_;
  next_.file = Output::File{std::move(row), std::move(fields), std::move(snapshots), std::move(coordinates)};
}

void RunRecorder::add_checkpoint(io::Checkpoint checkpoint, const std::string& stage, int stage_index, bool finished) {
  checkpoint.put_text("stage", stage);
  checkpoint.put_text("kind", provenance_.case_kind);
  host::save(totals_, checkpoint);
  const std::array<std::int64_t, 3> record{stage_index, result_index_, finished ? 1 : 0};
  checkpoint.put_integers("record", record);
  next_.checkpoint = std::move(checkpoint);
  next_.sequence = ++sequence_;
}

void RunRecorder::hand_over() {
  finish();
  if (!next_.file && !next_.checkpoint) return tell(std::exchange(next_, {}));
  thread_.submit([this, output = &given_.emplace(std::exchange(next_, {}))] { put_on_disk(*output); });
}

void RunRecorder::finish() {
  if (!given_) return;
  try {
    thread_.wait();
  } catch (...) {
    given_.reset();
    throw;
  }
  // NOLINTNEXTLINE(bugprone-unchecked-optional-access): it was there above, and the thread that writes leaves it there.
  const Output written = std::move(*given_);
  given_.reset();
  tell(written);
}

/// Called on the thread that writes, which alone uses the files meanwhile.
void RunRecorder::put_on_disk(Output& output) {
  const WriterTime start = WriterTime::now();
  const auto confirm_here = [&] {
    confirm_lock(options_, [&output](const std::string& changed) { output.warnings.push_back(changed); });
  };
  if (output.file) {
    confirm_here();
    const Output::File& file = *output.file;
    // NOLINTNEXTLINE(bugprone-unchecked-optional-access): only a finished run has no writer, and it has no increments.
    writer_->write(file.row, file.fields, file.snapshots, file.coordinates);
    output.file_bytes = static_cast<double>(std::filesystem::file_size(io::increment_path(folder_, file.row.index)));
  }
  if (output.checkpoint) {
    confirm_here();
    output.checkpoint_bytes = static_cast<double>(store_.save(output.sequence, *output.checkpoint));
  }
  output.time = WriterTime::now() - start;
}

void RunRecorder::tell(const Output& output) {
  for (const std::string& warning : output.warnings) log_.warning(warning);
  if (output.file) {
    ++files_;
    file_bytes_ += output.file_bytes;
  }
  if (output.checkpoint) checkpoint_bytes_ = output.checkpoint_bytes;
  if (!totals_.empty()) totals_.back().writer += output.time;
  if (!output.line.empty()) log_.line(output.line);
}

std::string RunRecorder::disk_use() const {
  return fmt::format("{} result files of {:.3g} MB, checkpoint of {:.3g} MB", files_,
                     file_bytes_ / std::max(files_, 1) * 1e-6, checkpoint_bytes_ * 1e-6);
}

void RunRecorder::set_table(const std::string& name, std::vector<io::TableColumn> columns) {
  finish();
  confirm();
  if (!writer_) {
    if (std::filesystem::exists(folder_ / "run.h5") && io::read_tables(folder_ / "run.h5").contains(name)) return;
    writer_ = io::ResultWriter::resume(folder_, provenance_, mesh_, result_index_);
  }
  writer_->set_table(name, std::move(columns));
}

}  // namespace voussoir::host
