#include "host/program/sweep_list.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <vector>

#include "host/estimate/report.hpp"
#include "io/input_error.hpp"
#include "io/run_list.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

/// Particle-steps that one core makes in a second of a whole run: of cases/tunnel_cps_d_cd3 in float 5.2e10 in 191 s on
/// two cores with AVX-512 (docs/measurements/whole_runs.md); double takes twice as long.
double rate_of(const Case& input) {
  constexpr double in_float = 1.4e8, in_double = 0.7e8;  // [1/s]
  return input.engine.precision == kernels::Precision::float32 ? in_float : in_double;
}

io::ListedRun listed(const PlannedRun& run, const fs::path& folder) {
  const AcceptedCase accepted = accept_run(run);
  const CaseSize& size = accepted.size;
  const double files = static_cast<double>(size.increments) / static_cast<double>(accepted.input.output.every);
  return {.name = run.name,
          .folder = fs::absolute(folder / run.name).lexically_normal().string(),
          .case_file = fs::absolute(run.case_file).lexically_normal().string(),
          .overrides = run.overrides,
          .kind = to_string(accepted.input.kind),
          .axes = run.axes,
          .fingerprint = accepted.input.fingerprint,
          .memory = size.memory,
          .disk = files * size.result_file + 2 * size.checkpoint,
          .core_time = size.particle_steps / rate_of(accepted.input)};
}

std::string table_of(const std::vector<io::ListedRun>& runs) {
  std::size_t width = 4;
  double core_time = 0, disk = 0, memory = 0;
  for (const io::ListedRun& run : runs) width = std::max(width, run.name.size());
  std::string text = fmt::format("{:<{}}  {:<12} {:>10} {:>9} {:>9}\n", "run", width, "kind", "core-hours", "memory",
                                 "disk");
  for (const io::ListedRun& run : runs) {
    core_time += run.core_time;
    disk += run.disk;
    memory = std::max(memory, run.memory);
    text += fmt::format("{:<{}}  {:<12} {:>10.3f} {:>9} {:>9}\n", run.name, width, run.kind, run.core_time / 3600,
                        bytes_text(run.memory), bytes_text(run.disk));
  }
  return text + fmt::format(
                    "{} runs take about {:.2g} core-hours without the making of packings (good to a factor of 3 with "
                    "AVX-512), at most {} of memory each, and {} on the disk\n",
                    runs.size(), core_time / 3600, bytes_text(memory), bytes_text(disk));
}

}  // namespace

AcceptedCase accept_run(const PlannedRun& run) {
  try {
    return accept_case(run.case_file, run.overrides);
  } catch (const io::InputError& fault) {
    throw io::InputError(run.place, "", fmt::format("run {}: {}", run.name, fault.what()));
  }
}

std::string list_of(const SweepPlan& plan, const fs::path& folder, bool as_json) {
  std::vector<io::ListedRun> runs;
  for (const PlannedRun& run : plan.runs) runs.push_back(listed(run, folder));
  if (!as_json) return table_of(runs);
  std::vector<io::ListedEnsemble> ensembles;
  for (const PlannedEnsemble& ensemble : plan.ensembles) {
    io::ListedEnsemble& point = ensembles.emplace_back(io::ListedEnsemble{.name = ensemble.name, .members = {}});
    for (const std::size_t number : ensemble.runs) point.members.push_back(plan.runs[number].name);
  }
  return io::run_list_json(fs::absolute(folder).lexically_normal().string(), runs, ensembles) + "\n";
}

}  // namespace voussoir::host
