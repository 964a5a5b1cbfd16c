#include "host/program/run_case.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>

#include "host/case/failure.hpp"
#include "host/element_tests/biaxial_run.hpp"
#include "host/element_tests/calibrate_run.hpp"
#include "host/element_tests/pack.hpp"
#include "host/element_tests/probe.hpp"
#include "host/kinds/biaxial_bvp.hpp"
#include "host/kinds/column.hpp"
#include "host/kinds/tunnel.hpp"
#include "host/record/log.hpp"
#include "host/scene/run_scene.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

/// A run goes on beyond an increment whose RVEs are not at rest at their step limit, but it does not end as a run in
/// equilibrium.
Outcome answer_of_finished(const RunOptions& options) {
  const std::vector<io::IncrementInfo> all = io::read_increments(options.folder / "run.h5");
  const auto restless = std::count_if(all.begin(), all.end(), [](const io::IncrementInfo& i) { return !i.converged; });
  if (restless == 0) return Outcome::done;
  std::fprintf(stderr, "%td of %zu increments did not converge (`converged` is 0 in the table of %s/run.h5)\n",
               restless, all.size(), options.folder.c_str());
  return Outcome::no_equilibrium;
}

Outcome answer(RunStatus status, const RunOptions& options) {
  const std::string folder = options.folder.string();
  switch (status) {
    case RunStatus::finished:
      return answer_of_finished(options);
    case RunStatus::interrupted:
      std::fprintf(stderr, "the run was stopped on request; `--resume` goes on from the last increment in %s\n",
                   folder.c_str());
      return Outcome::interrupted;
    case RunStatus::failed:
      std::fprintf(stderr, "no equilibrium was found (see %s/run.log), the last good checkpoint is kept: %s\n",
                   folder.c_str(), last_failure(options.folder / "run.log").c_str());
      return Outcome::no_equilibrium;
  }
  throw std::logic_error("a run ended in no known way");
}

Outcome run_kind(const Case& input, const RunOptions& options) {
  switch (input.kind) {
    case CaseKind::tunnel:
      return answer(run_tunnel(input, options), options);
    case CaseKind::column:
      return answer(run_column(input, options), options);
    case CaseKind::biaxial_bvp:
      return answer(run_biaxial_bvp(input, options), options);
    case CaseKind::scene:
      return answer(run_scene(input, options), options);
    case CaseKind::pack:
      return run_pack(input);
    case CaseKind::probe:
      return run_probe(input, options);
    case CaseKind::biaxial:
      return run_biaxial(input, options);
    case CaseKind::calibrate:
      return run_calibrate(input, options);
  }
  throw std::logic_error("a case of no known kind");
}

/// Adds the reason of a run's end to its log, which the exception itself does not reach.
void add_to_log(const RunOptions& options, const std::string& sentence) {
  const std::filesystem::path file = options.folder / "run.log";
  if (!std::filesystem::exists(file)) return;
  try {
    RunLog(file, true).detail("the run ends: " + sentence);
    // NOLINTNEXTLINE(bugprone-empty-catch): a disk that is full may be the reason itself, and it is on standard error.
  } catch (const std::exception&) {
  }
}

}  // namespace

Outcome run_case(const Case& input, const RunOptions& options) {
  if (options.replace) remove_earlier_run(options);
  if (!runs_on_a_mesh(input.kind)) {  // the kinds on a mesh have a log
    for (const std::string& line : {options.threads_note, options.lock ? options.lock->note() : std::string()}) {
      if (!line.empty()) std::printf("%s\n", line.c_str());
    }
    return run_kind(input, options);
  }
  try {
    return run_kind(input, options);
  } catch (...) {
    add_to_log(options, failure_of(std::current_exception()).sentence);
    throw;
  }
}

}  // namespace voussoir::host
