#include "host/stages/ground_run.hpp"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <utility>

#include "host/case/engine.hpp"
#include "host/process/interrupt.hpp"
#include "host/stages/ground_checkpoint.hpp"
#include "host/stages/profiling.hpp"
#include "kernels/isa/choose_lanes.hpp"

namespace voussoir::host {

StageSettings stage_settings(const Case& input) {
  return {.newton = input.newton, .output = input.output, .defer = input.engine.defer};
}

RunLog open_log(const RunOptions& options) {
  make_folder(options);
  confirm_lock(options, [](const std::string&) {});  // the log does not exist yet
  return {options.folder / "run.log", options.resume};
}

void tell_circumstances(const RunOptions& options, RunLog& log) {
  if (options.lock && !options.lock->note().empty()) log.warning(options.lock->note());
  if (!options.threads_note.empty()) log.line(options.threads_note);
}

void log_engine(const Case& input, RunLog& log) {
  if (!uses_engine(input.kind, input.material)) return;
  log.line(engine_note(input.engine, input.soil));
  log.line(kernels::lanes_sentence(kernels::chosen_lanes()));
}

GroundRun::GroundRun(const RunOptions& options, const io::Provenance& provenance, const fem::Mesh& mesh,
                     io::MeshData mesh_data, StageSettings settings, RunLog& log)
    : mesh_(mesh), settings_(std::move(settings)), recorder_(options, provenance, std::move(mesh_data), log) {
  show_parts_to_profilers();
}

void GroundRun::open_ground(const MaterialCase& material, const PackingNote& note) {
  material_ = make_material(material, mesh_, note);
  catch_interrupts();  // packings may take long and are kept one by one; from here on there are increments to end first
  ground_.emplace(Ground{mesh_, *material_, {}, {}});
  if (const io::Checkpoint* checkpoint = recorder_.resumed()) {
    restore(*ground_, *checkpoint);
    log().line(fmt::format("the run goes on behind increment {} of {}", recorder_.resumed_stage_index(),
                           recorder_.resumed_stage()));
  } else {
    begin_stage(*ground_);
  }
}

void GroundRun::report_finished() {
  recorder_.require_all_files();
  log().line(fmt::format("the run in {} is finished already, there is nothing to do", recorder_.folder().string()));
}

}  // namespace voussoir::host
