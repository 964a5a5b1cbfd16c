#include "host/estimate/report.hpp"

#include <spdlog/fmt/fmt.h>

#include "io/case_file.hpp"

namespace voussoir::host {

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes * 1e-3);
  return bytes < 1e9 ? fmt::format("{:.3g} MB", bytes * 1e-6) : fmt::format("{:.3g} GB", bytes * 1e-9);
}

std::string lanes_warning(const CaseSize& size) {
  constexpr double enough = 0.8;
  if (size.lanes_share >= enough) return "";
  return fmt::format(
      "the lanes are only {:.0f} % full, since those of a group hold points of one packing: with fewer "
      "packings (packing.variety) the same points cost less",
      100 * size.lanes_share);
}

void check_snapshot_points(const OutputCase& output, const CaseSize& size, const std::string& place) {
  for (const std::int64_t point : output.rves) {
    if (static_cast<std::size_t>(point) < size.points) continue;
    throw io::InputError(place, "output.rves",
                         fmt::format("names the point {}, but the mesh has only {} points", point, size.points));
  }
}

namespace {

/// Of a scene; describe_scene.hpp tells of each of its regions.
std::vector<std::string> describe_packings(const CaseSize& size) {
  if (size.packings == 0) return {};
  return {fmt::format("{} packing{} to be made or found; the lanes are {:.0f} % full", size.packings,
                      size.packings == 1 ? " has" : "s have", 100 * size.lanes_share)};
}

}  // namespace

std::vector<std::string> describe(const CaseSize& size, MaterialKind material, const PackingCase& packing,
                                  const OutputCase& output) {
  std::vector<std::string> lines;
  if (!size.regions.empty()) {
    lines = describe_packings(size);
  } else if (packing.files.size() > 1) {
    lines.push_back(
        fmt::format("packing.file names {} packings of at most {} grains; packing.grains, seeds and "
                    "density are not used",
                    packing.files.size(), packing.grains));
  } else if (!packing.files.empty()) {
    lines.push_back(
        fmt::format("packing.file holds {} grains; packing.grains, seeds and density are not used", packing.grains));
  } else if (material == MaterialKind::grains) {
    lines.push_back(fmt::format("{} packings of {} grains have to be made or found", size.packings, packing.grains));
  }
  if (size.tests > 0) {
    lines.push_back(fmt::format("{} tests take about {:.2g} particle-steps, the making of packings not included",
                                size.tests, size.particle_steps));
  }
  if (!size.regions.empty()) {
    lines.push_back(fmt::format("{} Gauss points; {} increments are planned", size.points, size.increments));
  } else if (size.points > 0) {
    lines.push_back(fmt::format("{} Gauss points in the largest mesh, {} in the column; {} increments are planned",
                                size.points, size.column_points, size.increments));
  }
  if (size.grains > 0) {
    lines.push_back(
        fmt::format("{:.3g} grains in all take about {:.2g} particle-steps (this estimate is good to a factor of {})",
                    size.grains, size.particle_steps, size.regions.empty() ? 2 : 3));
  }
  if (size.points > 0) {
    const auto files = static_cast<double>(size.increments) / output.every;
    lines.push_back(fmt::format(
        "the run takes about {} of memory, result files of {} each ({} in all) and two checkpoints of {} each",
        bytes_text(size.memory), bytes_text(size.result_file), bytes_text(files * size.result_file),
        bytes_text(size.checkpoint)));
  }
  return lines;
}

}  // namespace voussoir::host
