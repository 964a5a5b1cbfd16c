#include "host/record/recorder.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "host/record/provenance.hpp"

namespace voussoir::host {
namespace {

std::string duration(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

RunRecorder::RunRecorder(const RunOptions& options, const Case& input, const std::string& kind, io::MeshData mesh,
                         RunLog& log)
    : folder_(options.folder),
      log_(log),
      store_(options.folder / "checkpoints", input.fingerprint),
      provenance_(provenance_of(options, input, kind)),
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
  if (std::filesystem::exists(folder_ / "run.h5")) provenance_ = io::read_provenance(folder_ / "run.h5");
  if (!finished_) writer_ = io::ResultWriter::resume(folder_, provenance_, mesh_, result_index_);
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
  log_.live(fmt::format("{} {}/{}  at {:.4g}  iteration {}  residual {:.2e} of {:.2e} N/m  stage ends in {}", stage_,
                        stage_current_ + 1, stage_planned_, load_parameter, iterate.iteration, iterate.residual,
                        iterate.bound, time_left(stage_current_)));
}

void RunRecorder::report(const io::IncrementInfo& info) {
  stage_current_ = info.stage_index;
  std::string text = fmt::format("{} {}/{}: at {:.5g}, {} iterations, residual {:.1e}, {:.2g} s", info.stage,
                                 info.stage_index, stage_planned_, info.load_parameter, info.iterations, info.residual,
                                 info.wall_s);
  if (info.cuts > 0) text += fmt::format(", cut {} times", info.cuts);
  const auto column = [&](const char* name) { return info.extra.contains(name) ? info.extra.at(name).value : 0.0; };
  if (column("relaxations") > 0) text += fmt::format(", relaxed in {} substeps", column("relaxations"));
  if (column("open_points") > 0) text += fmt::format(", {} points open", column("open_points"));
  if (column("step_limit_points") > 0)
    text += fmt::format(", {} points at the step limit", column("step_limit_points"));
  if (column("deferred_points") > 0) text += fmt::format(", {} points deferred", column("deferred_points"));
  if (column("deferral_error") > 0) text += fmt::format(", deferral was off by {:.1e} p", column("deferral_error"));
  if (column("slowest_steps") > 0) {
    text += fmt::format(", slowest RVE {} with {} steps", column("slowest_point"), column("slowest_steps"));
  }
  if (stage_current_ < stage_planned_) text += fmt::format("; stage ends in {}", time_left(stage_current_));
  log_.line(text);
}

void RunRecorder::write(io::IncrementInfo info, const std::vector<io::Field>& fields,
                        const std::vector<io::RveSnapshot>& snapshots, const std::vector<double>& coordinates) {
  info.index = ++result_index_;
  writer_->write(info, fields, snapshots, coordinates);
  ++files_;
  file_bytes_ += static_cast<double>(std::filesystem::file_size(io::increment_path(folder_, info.index)));
}

std::string RunRecorder::disk_use() const {
  return fmt::format("{} result files of {:.3g} MB, checkpoint of {:.3g} MB", files_,
                     file_bytes_ / std::max(files_, 1) * 1e-6, checkpoint_bytes_ * 1e-6);
}

void RunRecorder::set_table(const std::string& name, std::vector<io::TableColumn> columns) {
  if (!writer_) {
    if (std::filesystem::exists(folder_ / "run.h5") && io::read_tables(folder_ / "run.h5").contains(name)) return;
    writer_ = io::ResultWriter::resume(folder_, provenance_, mesh_, result_index_);
  }
  writer_->set_table(name, std::move(columns));
}

void RunRecorder::save(io::Checkpoint checkpoint, const std::string& stage, int stage_index, bool finished) {
  checkpoint.put_text("stage", stage);
  host::save(totals_, checkpoint);
  const std::array<std::int64_t, 3> record{stage_index, result_index_, finished ? 1 : 0};
  checkpoint.put_integers("record", record);
  checkpoint_bytes_ = 0;
  for (const auto& [name, bytes] : checkpoint.blobs()) checkpoint_bytes_ += static_cast<double>(bytes.size());
  store_.save(++sequence_, checkpoint);
}

}  // namespace voussoir::host
