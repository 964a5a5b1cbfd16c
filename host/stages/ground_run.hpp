#pragma once
/// A run of the ground in one folder. Tunnel, column and biaxial specimen open their log, record, material and ground
/// here, all in the same way; the stages then move the ground and keep the record.

#include <memory>
#include <optional>
#include <string>

#include "host/case/case.hpp"
#include "host/record/log.hpp"
#include "host/record/recorder.hpp"
#include "host/stages/ground.hpp"
#include "host/stages/make_material.hpp"

namespace voussoir::host {

/// Settings that all stages of a run have in common: the criteria of equilibrium, and the choice of output.
struct StageSettings {
  NewtonCase newton;
  OutputCase output;
  double defer = 0;  ///< EngineCase::defer: change of stress over pressure up to which RVEs may answer by their tangent
};
[[nodiscard]] StageSettings stage_settings(const Case& input);

/// Makes the folder of a run and opens its log there.
[[nodiscard]] RunLog open_log(const RunOptions& options);

/// Writes the preset of the engine and the set of its lanes to the log, where the case has grains.
void log_engine(const Case& input, RunLog& log);
/// Tells the log how many threads there are and what is to be said about the lock of the folder.
void tell_circumstances(const RunOptions& options, RunLog& log);

class GroundRun {
 public:
  /// Starts the record in options.folder, or goes on with the record there. `mesh` and `log` must outlive the run.
  GroundRun(const RunOptions& options, const io::Provenance& provenance, const fem::Mesh& mesh, io::MeshData mesh_data,
            StageSettings settings, RunLog& log);

  /// Makes the material and the ground. The ground is restored from the checkpoint with which the record goes on;
  /// without a checkpoint it stands at the beginning of its first stage. `note` receives lines for the log about slow
  /// steps.
  void open_ground(const MaterialCase& material, const PackingNote& note);

  [[nodiscard]] bool finished() const { return recorder_.finished(); }  ///< an earlier process has finished this run
  /// Tells the log that a finished run has nothing left to do.
  void report_finished();

  // NOLINTNEXTLINE(bugprone-unchecked-optional-access): value() itself checks, and throws.
  [[nodiscard]] Ground& ground() { return ground_.value(); }  ///< may be called only after open_ground
  [[nodiscard]] RunRecorder& recorder() { return recorder_; }
  [[nodiscard]] RunLog& log() { return recorder_.log(); }
  [[nodiscard]] const StageSettings& settings() const { return settings_; }

 private:
  const fem::Mesh& mesh_;
  StageSettings settings_;
  RunRecorder recorder_;
  std::unique_ptr<fem::MaterialBatch> material_;
  std::optional<Ground> ground_;
};

}  // namespace voussoir::host
