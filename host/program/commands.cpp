#include "host/program/commands.hpp"

#include <cstdio>
#include <memory>
#include <stdexcept>

#include "host/case/engine.hpp"
#include "host/case/load_case.hpp"
#include "host/estimate/report.hpp"
#include "host/estimate/work.hpp"
#include "host/process/interrupt.hpp"
#include "host/process/threads.hpp"
#include "host/program/run_case.hpp"
#include "host/ranks/session.hpp"
#include "io/case_file.hpp"
#include "io/input_error.hpp"
#include "io/result_file.hpp"

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

Outcome command_run(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                    RunOptions options) {
  const Case input = load_case(case_file, overrides);
  if (options.folder.empty()) options.folder = std::filesystem::path("out") / input.name;
  expect_unlocked(options.folder);  // more to the point than what check_folder would say of a run that has just begun
  check_folder(options, input.fingerprint);
  if (!input.output.rves.empty()) check_snapshot_points(input.output, case_size(input), input.name);
  const KokkosSession kokkos(options.threads);
  start_ranks(options.threads);
  options.threads = kokkos.threads().count;
  options.threads_note = kokkos.threads().note;
  // Only a kind that advances in increments can stop between two of them; the others end at once.
  runs_on_a_mesh(input.kind) ? catch_interrupts() : end_on_interrupts(exit_code(Outcome::interrupted));
  // A case of this kind writes into the folder of packings only, but it removes what lies in its own with --replace.
  if (input.kind != CaseKind::pack || std::filesystem::exists(options.folder)) {
    options.lock = std::make_shared<RunLock>(options.folder, options.take_over);
    check_folder(options, input.fingerprint);  // once more: another run may have ended between the check and the lock
  }
  return run_case(input, options);
}

Outcome command_check(const std::filesystem::path& case_file, const std::vector<std::string>& overrides) {
  const Case input = load_case(case_file, overrides);
  std::printf("%s\n", input.resolved.c_str());
  if (uses_engine(input.kind, input.material)) std::printf("# %s\n", engine_note(input.engine).c_str());
  const CaseSize size = case_size(input);
  check_snapshot_points(input.output, size, input.name);
  for (const std::string& line : describe(size, input.material, input.packing, input.output))
    std::printf("# %s\n", line.c_str());
  return Outcome::done;
}

Outcome command_info(const std::filesystem::path& result_file) {
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
    throw io::InputError("info", "", error.what());
  }
  return Outcome::done;
}

}  // namespace voussoir::host
