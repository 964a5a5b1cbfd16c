#include "host/program/commands.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include "host/case/engine.hpp"
#include "host/case/load_case.hpp"
#include "host/estimate/report.hpp"
#include "host/kinds/tunnel_mesh.hpp"
#include "host/material/devices.hpp"
#include "host/packing/draw_scatter.hpp"
#include "host/process/interrupt.hpp"
#include "host/process/standard_streams.hpp"
#include "host/process/threads.hpp"
#include "host/program/accept_case.hpp"
#include "host/program/run_case.hpp"
#include "host/ranks/session.hpp"
#include "io/case_file.hpp"
#include "io/input_error.hpp"
#include "io/mesh_file.hpp"
#include "io/result_file.hpp"
#include "io/text_file.hpp"
#include "kernels/isa/choose_lanes.hpp"

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

std::string table_of(const std::vector<io::IncrementInfo>& increments) {
  std::string text = fmt::format("{:>5}  {:<12} {:>5}  {:>12}  {:>6}  {:>5}  {:>9}  {:>10}  {:>8}  {}\n", "file",
                                 "stage", "index", "load", "iter.", "cuts", "residual", "part.steps", "wall [s]",
                                 "status");
  for (const io::IncrementInfo& info : increments) {
    text += fmt::format("{:5d}  {:<12} {:5d}  {:12.6g}  {:6d}  {:5d}  {:9.2e}  {:10.3g}  {:8.2f}  {}\n", info.index,
                        info.stage, info.stage_index, info.load_parameter, info.iterations, info.cuts, info.residual,
                        info.particle_steps, info.wall_s, status_of(info));
  }
  return text;
}

}  // namespace

Outcome command_run(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                    RunOptions options) {
  const AcceptedCase accepted = accept_case(case_file, overrides);
  const Case& input = accepted.input;
  const kernels::LaneChoice& lanes = kernels::choose_lanes(input.engine.isa);
  if (options.folder.empty()) options.folder = std::filesystem::path("out") / input.name;
  expect_unlocked(options.folder);  // more to the point than what check_folder would say of a run that has just begun
  check_folder(options, identity_of(input));
  const KokkosSession kokkos(options.threads);
  start_ranks(options.threads, input.engine.isa);
  refuse_too_large(input, accepted.size, rank_count());
  options.threads = kokkos.threads().count;
  options.threads_note = kokkos.threads().note;
  // A run on a mesh stops between two increments. While grains are packed (GroundRun says when this is over), and in
  // all other kinds, there is no increment to end first.
  const bool has_increments = runs_on_a_mesh(input.kind) && input.material != MaterialKind::grains;
  has_increments ? catch_interrupts() : end_on_interrupts(exit_code(Outcome::interrupted));
  // A case of this kind writes into the folder of packings only, but it removes what lies in its own with --replace.
  if (input.kind != CaseKind::pack || std::filesystem::exists(options.folder)) {
    options.lock = std::make_shared<RunLock>(options.folder, options.take_over);
    // Once more, since another run may have ended between the check and the lock.
    check_folder(options, identity_of(input));
  }
  if (!runs_on_a_mesh(input.kind)) std::printf("%s\n", kernels::lanes_sentence(lanes).c_str());  // others have a log
  const Outcome outcome = run_case(input, options);
  if (const auto reason = lost_output()) {  // only kinds without a log come here; a log has told of the loss already
    std::fprintf(stderr, "voussoir: standard output cannot be written (%s), its lines are lost, the files are not\n",
                 reason->c_str());
  }
  return outcome;
}

Outcome command_check(const std::filesystem::path& case_file, const std::vector<std::string>& overrides) {
  const auto [input, size, range] = accept_case(case_file, overrides);
  refuse_too_large(input, size, rank_count());
  std::string answer = input.resolved + "\n";
  if (uses_engine(input.kind, input.material)) answer += "# " + engine_note(input.engine, input.soil) + "\n";
  answer += "# " + kernels::lanes_sentence(kernels::choose_lanes(input.engine.isa)) + "\n";
  if (const std::string line = sentence_of(choose_device(input, local_rank())); !line.empty())
    answer += "# " + line + "\n";
  for (const std::string& line : size.sentences) answer += "# " + line + "\n";
  for (const std::string& line : describe(size, input.material, input.packing, input.output))
    answer += "# " + line + "\n";
  if (!range.empty()) answer += "# " + range + "\n";
  if (input.kind == CaseKind::tunnel && input.material == MaterialKind::grains)
    answer += "# " + draw_sentence(input.packing, input.volume_loss.total) + "\n";
  for (const std::string& remark : input.remarks) answer += "# warning: " + remark + "\n";
  return print_answer(answer);
}

Outcome command_mesh(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                     const std::filesystem::path& target, bool replace) {
  const Case input = load_case(case_file, overrides);
  if (input.kind != CaseKind::tunnel)
    throw io::InputError(place_of(input, "kind"), "kind",
                         fmt::format("is \"{}\": only a tunnel has a mesh that is generated", to_string(input.kind)));
  if (!input.ground.mesh_file.empty())
    throw io::InputError(place_of(input, "ground.mesh_file"), "ground.mesh_file",
                         "names a mesh that is stored already");
  if (!replace && std::filesystem::exists(target))
    throw io::InputError("--output", target.string(), "is there already: add --replace to overwrite it");
  refuse_endless_mesh(input);
  const io::StoredMesh mesh = mesh_to_store(input.ground);
  io::save_mesh(target, mesh);
  return print_answer(
      fmt::format("{}: {} elements, {} Gauss points\n", target.string(), mesh.elements(), 4 * mesh.elements()));
}

Outcome command_info(const std::filesystem::path& result_file) {
  std::string answer;
  try {  // for this command a file that cannot be read is wrong input
    const io::Provenance origin = io::read_provenance(result_file);
    answer = fmt::format(
        "kind {}, version {} ({}), {}, {} ranks, {} threads, begun {}\nbuild: {}, {}\nprocessor: {}\nlanes: {}\n"
        "device: {}\n"
        "command: {}\nfingerprint: {}\n",
        origin.case_kind, origin.version, origin.git_hash, origin.kokkos, origin.ranks, origin.threads, origin.date,
        origin.build_compiler, origin.build_type, origin.processor, origin.lanes, origin.device, origin.command,
        origin.fingerprint);
    const io::MeshData mesh = io::read_mesh(result_file);
    answer += fmt::format("{} nodes, {} elements\n", mesh.nodes(), mesh.elements()) +
              table_of(io::read_increments(result_file));
  } catch (const std::runtime_error& error) {
    throw io::InputError("info", "", error.what());
  }
  return print_answer(answer);
}

Outcome command_info_cpu() {
  std::string held;
  for (const kernels::LaneSet* lanes : kernels::compiled_lanes())
    held += fmt::format("{}{}", held.empty() ? "" : ", ", kernels::name_of(lanes->isa));
  return print_answer(fmt::format("processor: {}, which offers {}\nthis program holds the lanes {}\n{}\n",
                                  kernels::processor_name(), kernels::description_of(kernels::processor_set()), held,
                                  kernels::lanes_sentence(kernels::choose_lanes({}))));
}

Outcome command_info_devices() { return print_answer(devices_sentence()); }

}  // namespace voussoir::host
