// What a case takes of memory and disk, and the lines of `check`.
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "host/case/result_fields.hpp"
#include "host/estimate/work.hpp"
#include "host/packing/packings.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {
namespace {

// Measured: 984 RVEs of 300 grains took 179.5 MB, checkpoints of 18.94 MB and result files of 278 kB; 3344 RVEs of 700
// grains 915.8 MB, 148.1 MB and, with five whole RVEs, 1.33 MB.
constexpr double process_bytes = 73e6;    ///< of the program with its libraries
constexpr double memory_a_grain = 360.0;  ///< committed and trial state with room for four contacts a grain, a
                                          ///< checkpoint's copies
constexpr double contacts_a_grain = 1.93;
constexpr double nodes_a_point = 0.79;  ///< of the study's meshes: 3.16 nodes an element
constexpr double file_overhead = 30e3;  ///< attributes and groups of a result file

bool is_wanted(const OutputCase& output, const ResultField& field) {
  const auto& names = output.fields;
  return is_asked_for(field, output.microstructure) &&
         (names.empty() || std::find(names.begin(), names.end(), field.name) != names.end());
}

/// ParaView's copies included: vectors with a third component, means over the four points of an element.
double result_file_bytes(const Case& input, double points, double nodes) {
  double bytes = file_overhead;
  for (const ResultField& field : result_field_table) {
    if (!is_wanted(input.output, field) || (field.of_grains && input.material != MaterialKind::grains)) continue;
    bytes += 8.0 * field.components * (field.location == io::FieldLocation::node ? 2.5 * nodes : 1.25 * points);
  }
  const double snapshot = 32.0 + 48.0 * contacts_a_grain;  // bytes a grain
  return bytes + static_cast<double>(input.output.rves.size()) * input.packing.grains * snapshot;
}

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes * 1e-3);
  return bytes < 1e9 ? fmt::format("{:.3g} MB", bytes * 1e-6) : fmt::format("{:.3g} GB", bytes * 1e-9);
}

}  // namespace

void add_storage(const Case& input, CaseSize& size) {
  const auto points = static_cast<double>(size.points);
  size.result_file = result_file_bytes(input, points, nodes_a_point * points);
  // Committed RVEs (position and rotation; key and history of each contact) and the mesh's own state.
  size.checkpoint = size.grains * (24.0 + 20.0 * contacts_a_grain) + 300.0 * points;
  size.memory = process_bytes + memory_a_grain * size.grains;
}

void check_snapshot_points(const Case& input, const CaseSize& size) {
  for (const std::int64_t point : input.output.rves) {
    if (static_cast<std::size_t>(point) < size.points) continue;
    throw io::InputError(input.name, "output.rves", fmt::format("names point {} of {}", point, size.points));
  }
}

std::vector<std::string> describe(const Case& input, const CaseSize& size) {
  std::vector<std::string> lines;
  if (!input.packing.file.empty()) {
    lines.push_back(fmt::format("packing.file holds {} grains; packing.grains, seeds and density do not count",
                                input.packing.grains));
  } else if (input.material == MaterialKind::grains) {
    lines.push_back(fmt::format("{} packings of {} grains to be made or found", size.packings, input.packing.grains));
  }
  if (size.tests > 0) {
    lines.push_back(
        fmt::format("{} tests, about {:.2g} particle-steps, packings apart", size.tests, size.particle_steps));
  }
  if (size.points > 0) {
    lines.push_back(fmt::format("{} Gauss points, {} in the column, {} increments planned", size.points,
                                size.column_points, size.increments));
  }
  if (size.grains > 0) {
    lines.push_back(
        fmt::format("{:.3g} grains in all, about {:.2g} particle-steps (an estimate, good to a factor of 2)",
                    size.grains, size.particle_steps));
  }
  if (size.points > 0) {
    const auto files = static_cast<double>(size.increments) / input.output.every;
    lines.push_back(
        fmt::format("about {} of memory; result files of {} each, {} in all; checkpoints of {}, two are kept",
                    bytes_text(size.memory), bytes_text(size.result_file), bytes_text(files * size.result_file),
                    bytes_text(size.checkpoint)));
  }
  return lines;
}

}  // namespace voussoir::host
