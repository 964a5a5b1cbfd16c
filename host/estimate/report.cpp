#include "host/estimate/report.hpp"

#include <spdlog/fmt/fmt.h>

#include "io/case_file.hpp"

namespace voussoir::host {
namespace {

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes * 1e-3);
  return bytes < 1e9 ? fmt::format("{:.3g} MB", bytes * 1e-6) : fmt::format("{:.3g} GB", bytes * 1e-9);
}

}  // namespace

void check_snapshot_points(const OutputCase& output, const CaseSize& size, const std::string& case_name) {
  for (const std::int64_t point : output.rves) {
    if (static_cast<std::size_t>(point) < size.points) continue;
    throw io::InputError(case_name, "output.rves", fmt::format("names point {} of {}", point, size.points));
  }
}

std::vector<std::string> describe(const CaseSize& size, MaterialKind material, const PackingCase& packing,
                                  const OutputCase& output) {
  std::vector<std::string> lines;
  if (!packing.file.empty()) {
    lines.push_back(
        fmt::format("packing.file holds {} grains; packing.grains, seeds and density do not count", packing.grains));
  } else if (material == MaterialKind::grains) {
    lines.push_back(fmt::format("{} packings of {} grains to be made or found", size.packings, packing.grains));
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
    const auto files = static_cast<double>(size.increments) / output.every;
    lines.push_back(
        fmt::format("about {} of memory; result files of {} each, {} in all; checkpoints of {}, two are kept",
                    bytes_text(size.memory), bytes_text(size.result_file), bytes_text(files * size.result_file),
                    bytes_text(size.checkpoint)));
  }
  return lines;
}

}  // namespace voussoir::host
