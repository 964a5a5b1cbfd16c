#include "host/program/commands.hpp"

#include <spdlog/fmt/fmt.h>

#include <Kokkos_Core.hpp>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "host/case/engine.hpp"
#include "host/case/load_case.hpp"
#include "host/estimate/report.hpp"
#include "host/estimate/work.hpp"
#include "host/process/exit_code.hpp"
#include "host/process/interrupt.hpp"
#include "host/process/standard_streams.hpp"
#include "host/program/run_case.hpp"
#include "host/ranks/session.hpp"
#include "io/case_file.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

std::string table_of(const std::vector<io::IncrementInfo>& increments) {
  std::string text = fmt::format("{:>5}  {:<12} {:>5}  {:>12}  {:>6}  {:>5}  {:>9}  {:>10}  {:>8}\n", "file", "stage",
                                 "index", "load", "iter.", "cuts", "residual", "part.steps", "wall [s]");
  for (const io::IncrementInfo& info : increments) {
    text += fmt::format("{:5d}  {:<12} {:5d}  {:12.6g}  {:6d}  {:5d}  {:9.2e}  {:10.3g}  {:8.2f}\n", info.index,
                        info.stage, info.stage_index, info.load_parameter, info.iterations, info.cuts, info.residual,
                        info.particle_steps, info.wall_s);
  }
  return text;
}

}  // namespace

int command_run(const std::filesystem::path& case_file, const std::vector<std::string>& overrides, RunOptions options) {
  const Case input = load_case(case_file, overrides);
  if (options.folder.empty()) options.folder = std::filesystem::path("out") / input.name;
  check_folder(options, input.fingerprint);
  Kokkos::InitializationSettings settings;
  settings.set_disable_warnings(true);
  if (options.threads > 0) settings.set_num_threads(options.threads);
  const Kokkos::ScopeGuard kokkos(settings);
  start_ranks(options.threads);
  options.threads = Kokkos::DefaultHostExecutionSpace().concurrency();
  // Only a kind that advances in increments can stop between two of them; the others are ended by the signal itself.
  if (runs_on_a_mesh(input.kind)) catch_interrupts();
  const int code = run_case(input, options);
  if (const auto reason = lost_output()) {  // only kinds without a log come here; a log has told of the loss already
    std::fprintf(stderr, "voussoir: standard output cannot be written (%s), its lines are lost, the files are not\n",
                 reason->c_str());
  }
  return code;
}

int command_check(const std::filesystem::path& case_file, const std::vector<std::string>& overrides) {
  const Case input = load_case(case_file, overrides);
  std::string answer = input.resolved + "\n";
  if (uses_engine(input.kind, input.material)) answer += "# " + engine_note(input.engine) + "\n";
  const CaseSize size = case_size(input);
  check_snapshot_points(input.output, size, input.name);
  for (const std::string& line : describe(size, input.material, input.packing, input.output))
    answer += "# " + line + "\n";
  return print_answer(answer) ? exit_ok : exit_machine;
}

int command_info(const std::filesystem::path& result_file) {
  std::string answer;
  try {  // for this command a file that cannot be read is wrong input
    const io::Provenance origin = io::read_provenance(result_file);
    answer = fmt::format(
        "kind {}, version {} ({}), {}, {} ranks, {} threads, begun {}\nbuild: {}, {}\ncommand: {}\nfingerprint: {}\n",
        origin.case_kind, origin.version, origin.git_hash, origin.kokkos, origin.ranks, origin.threads, origin.date,
        origin.build_compiler, origin.build_type, origin.command, origin.fingerprint);
    const io::MeshData mesh = io::read_mesh(result_file);
    answer += fmt::format("{} nodes, {} elements\n", mesh.nodes(), mesh.elements()) +
              table_of(io::read_increments(result_file));
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(error.what());
  }
  return print_answer(answer) ? exit_ok : exit_machine;
}

}  // namespace voussoir::host
