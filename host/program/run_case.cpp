#include "host/program/run_case.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdint>
#include <cstdio>

#include "host/element_tests/biaxial_run.hpp"
#include "host/element_tests/calibrate_run.hpp"
#include "host/element_tests/pack.hpp"
#include "host/element_tests/probe.hpp"
#include "host/process/exit_code.hpp"
#include "host/stages/biaxial_bvp.hpp"
#include "host/stages/column.hpp"
#include "host/stages/tunnel.hpp"

namespace voussoir::host {
namespace {

int answer(RunStatus status, const RunOptions& options) {
  const std::string folder = options.folder.string();
  switch (status) {
    case RunStatus::finished:
      return exit_ok;
    case RunStatus::interrupted:
      std::fprintf(stderr, "the run was stopped on request; `--resume` goes on from the last increment in %s\n",
                   folder.c_str());
      return exit_interrupted;
    case RunStatus::failed:
      std::fprintf(stderr, "no equilibrium was found (see %s/run.log); the last good checkpoint is kept\n",
                   folder.c_str());
      return exit_numerical;
  }
  return exit_machine;
}

}  // namespace

int run_case(const Case& input, const RunOptions& options) {
  if (options.replace) remove_earlier_run(options);
  switch (input.kind) {
    case CaseKind::tunnel:
      return answer(run_tunnel(input, options), options);
    case CaseKind::column:
      return answer(run_column(input, options), options);
    case CaseKind::biaxial_bvp:
      return answer(run_biaxial_bvp(input, options), options);
    case CaseKind::pack:
      return run_pack(input);
    case CaseKind::probe:
      return run_probe(input, options);
    case CaseKind::biaxial:
      return run_biaxial(input, options);
    case CaseKind::calibrate:
      return run_calibrate(input, options);
  }
  return exit_machine;
}

}  // namespace voussoir::host
