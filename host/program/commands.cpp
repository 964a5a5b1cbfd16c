#include "host/program/commands.hpp"

#include <spdlog/fmt/fmt.h>

#include <Kokkos_Core.hpp>
#include <cstdio>
#include <stdexcept>

#include "host/case/engine.hpp"
#include "host/case/load_case.hpp"
#include "host/estimate/range.hpp"
#include "host/estimate/report.hpp"
#include "host/estimate/work.hpp"
#include "host/process/exit_code.hpp"
#include "host/process/interrupt.hpp"
#include "host/program/run_case.hpp"
#include "host/ranks/session.hpp"
#include "io/case_file.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

/// "converged", or with the number of RVEs that were not at rest.
std::string status_of(const io::IncrementInfo& info) {
  const auto restless = info.extra.find("step_limit_points");
  if (restless == info.extra.end() || !(restless->second.value > 0))
    return info.converged ? "converged" : "not converged";
  return fmt::format("{}, {:.0f} RVEs not at rest", info.converged ? "in equilibrium" : "not converged",
                     restless->second.value);
}

void print_increments(const std::vector<io::IncrementInfo>& increments) {
  std::printf("%5s  %-12s %5s  %12s  %6s  %5s  %9s  %10s  %8s  %s\n", "file", "stage", "index", "load", "iter.", "cuts",
              "residual", "part.steps", "wall [s]", "status");
  for (const io::IncrementInfo& info : increments) {
    std::printf("%5d  %-12s %5d  %12.6g  %6d  %5d  %9.2e  %10.3g  %8.2f  %s\n", info.index, info.stage.c_str(),
                info.stage_index, info.load_parameter, info.iterations, info.cuts, info.residual, info.particle_steps,
                info.wall_s, status_of(info).c_str());
  }
}

}  // namespace

int command_run(const std::filesystem::path& case_file, const std::vector<std::string>& overrides, RunOptions options) {
  Case input = load_case(case_file, overrides);
  for (std::string& warning : foretell(input).warnings) input.remarks.push_back(std::move(warning));
  if (options.folder.empty()) options.folder = std::filesystem::path("out") / input.name;
  check_folder(options, input.fingerprint, input.resolved);
  Kokkos::InitializationSettings settings;
  settings.set_disable_warnings(true);
  if (options.threads > 0) settings.set_num_threads(options.threads);
  const Kokkos::ScopeGuard kokkos(settings);
  start_ranks(options.threads);
  options.threads = Kokkos::DefaultHostExecutionSpace().concurrency();
  // Only a kind that advances in increments can stop between two of them; the others are ended by the signal itself.
  if (runs_on_a_mesh(input.kind)) catch_interrupts();
  return run_case(input, options);
}

int command_check(const std::filesystem::path& case_file, const std::vector<std::string>& overrides) {
  const Case input = load_case(case_file, overrides);
  std::printf("%s\n", input.resolved.c_str());
  if (uses_engine(input.kind, input.material)) std::printf("# %s\n", engine_note(input.engine).c_str());
  const CaseSize size = case_size(input);
  check_snapshot_points(input.output, size, input.name);
  for (const std::string& line : describe(size, input.material, input.packing, input.output))
    std::printf("# %s\n", line.c_str());
  const Foretold range = foretell(input);
  if (!range.line.empty()) std::printf("# %s\n", range.line.c_str());
  for (const std::vector<std::string>* remarks : {&range.warnings, &input.remarks}) {
    for (const std::string& remark : *remarks) std::printf("# warning: %s\n", remark.c_str());
  }
  return exit_ok;
}

int command_info(const std::filesystem::path& result_file) {
  try {  // for this command a file that cannot be read is wrong input
    const io::Provenance origin = io::read_provenance(result_file);
    std::printf(
        "kind %s, version %s (%s), %s, %d ranks, %d threads, begun %s\nbuild: %s, %s\ncommand: %s\nfingerprint: %s\n",
        origin.case_kind.c_str(), origin.version.c_str(), origin.git_hash.c_str(), origin.kokkos.c_str(), origin.ranks,
        origin.threads, origin.date.c_str(), origin.build_compiler.c_str(), origin.build_type.c_str(),
        origin.command.c_str(), origin.fingerprint.c_str());
    const io::MeshData mesh = io::read_mesh(result_file);
    std::printf("%zu nodes, %zu elements\n", mesh.nodes(), mesh.elements());
    print_increments(io::read_increments(result_file));
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(error.what());
  }
  return exit_ok;
}

}  // namespace voussoir::host
