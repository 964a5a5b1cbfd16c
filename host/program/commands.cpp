#include "host/program/commands.hpp"

#include <spdlog/fmt/fmt.h>

#include <Kokkos_Core.hpp>
#include <cstdio>
#include <stdexcept>

#include "host/case/engine.hpp"
#include "host/case/load_case.hpp"
#include "host/estimate/report.hpp"
#include "host/process/exit_code.hpp"
#include "host/process/interrupt.hpp"
#include "host/program/accept_case.hpp"
#include "host/program/run_case.hpp"
#include "host/ranks/session.hpp"
#include "io/case_file.hpp"
#include "io/input_error.hpp"
#include "io/result_file.hpp"
#include "io/text_file.hpp"

namespace voussoir::host {
namespace {

void print_increments(const std::vector<io::IncrementInfo>& increments) {
  std::printf("%5s  %-12s %5s  %12s  %6s  %5s  %9s  %10s  %8s\n", "file", "stage", "index", "load", "iter.", "cuts",
              "residual", "part.steps", "wall [s]");
  for (const io::IncrementInfo& info : increments) {
    std::printf("%5d  %-12s %5d  %12.6g  %6d  %5d  %9.2e  %10.3g  %8.2f\n", info.index, info.stage.c_str(),
                info.stage_index, info.load_parameter, info.iterations, info.cuts, info.residual, info.particle_steps,
                info.wall_s);
  }
}

}  // namespace

int command_run(const std::filesystem::path& case_file, const std::vector<std::string>& overrides, RunOptions options) {
  const AcceptedCase accepted = accept_case(case_file, overrides);
  const Case& input = accepted.input;
  if (options.folder.empty()) options.folder = std::filesystem::path("out") / input.name;
  check_folder(options, input.fingerprint);
  Kokkos::InitializationSettings settings;
  settings.set_disable_warnings(true);
  if (options.threads > 0) settings.set_num_threads(options.threads);
  const Kokkos::ScopeGuard kokkos(settings);
  start_ranks(options.threads);
  refuse_too_large(input, accepted.size, rank_count());
  options.threads = Kokkos::DefaultHostExecutionSpace().concurrency();
  // Only a kind that advances in increments can stop between two of them; the others are ended by the signal itself.
  if (runs_on_a_mesh(input.kind)) catch_interrupts();
  return run_case(input, options);
}

int command_check(const std::filesystem::path& case_file, const std::vector<std::string>& overrides) {
  const auto [input, size] = accept_case(case_file, overrides);
  refuse_too_large(input, size, rank_count());
  std::printf("%s\n", input.resolved.c_str());
  if (uses_engine(input.kind, input.material)) std::printf("# %s\n", engine_note(input.engine).c_str());
  for (const std::string& line : describe(size, input.material, input.packing, input.output))
    std::printf("# %s\n", line.c_str());
  return exit_ok;
}

int command_keys(const std::string& kind) {
  for (const auto& [candidate, name] : case_kind_names) {
    if (kind != name) continue;
    std::printf("%s", io::key_table(keys_of(candidate)).c_str());
    return exit_ok;
  }
  std::string names;
  for (const auto& [candidate, name] : case_kind_names) names += (names.empty() ? "" : ", ") + std::string(name);
  throw io::InputError("keys", "", "the kind must be one of " + names + ", is " + io::in_one_line(kind));
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
