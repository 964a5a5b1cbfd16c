#include "host/run_case.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <filesystem>

#include "host/biaxial.hpp"
#include "host/exit_code.hpp"
#include "host/packing.hpp"
#include "host/tunnel.hpp"

namespace voussoir::host {
namespace {

RunStatus run_column_case(const Case& input, const RunOptions& options) {
  std::filesystem::create_directories(options.folder);
  RunLog log(options.folder / "run.log", options.resume);
  return run_column(input, options, log).status;
}

int answer(RunStatus status, const RunOptions& options) {
  const std::string folder = options.folder.string();
  switch (status) {
    case RunStatus::finished: return exit_ok;
    case RunStatus::interrupted:
      std::fprintf(stderr, "stopped on request; `--resume` goes on from the last increment in %s\n", folder.c_str());
      return exit_interrupted;
    case RunStatus::failed:
      std::fprintf(stderr, "no equilibrium found, see %s/run.log; the last good checkpoint stays\n", folder.c_str());
      return exit_numerical;
  }
  return exit_machine;
}

}  // namespace

int run_case(const Case& input, const RunOptions& options) {
  switch (input.kind) {
    case CaseKind::tunnel: return answer(run_tunnel(input, options), options);
    case CaseKind::column: return answer(run_column_case(input, options), options);
    case CaseKind::pack: return run_pack(input, options);
    case CaseKind::probe: return run_probe(input, options);
    case CaseKind::biaxial: return run_biaxial(input, options);
  }
  return exit_machine;
}

}  // namespace voussoir::host
