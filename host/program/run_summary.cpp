#include "host/program/run_summary.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <exception>
#include <set>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

/// The increments of a run; none where it has no results, or where they have vanished or are damaged.
std::vector<io::IncrementInfo> increments_of(const ProcessRun& run) {
  try {
    if (std::filesystem::exists(run.folder / "run.h5")) return io::read_increments(run.folder / "run.h5");
  } catch (const std::exception& damage) {
    std::fprintf(stderr, "voussoir: the summary has no values of %s: %s\n", run.name.c_str(), damage.what());
  }
  return {};
}

}  // namespace

void write_summary(std::span<const ProcessRun> runs, const std::filesystem::path& file) {
  std::vector<std::vector<io::IncrementInfo>> tables;
  std::set<std::string> columns;
  for (const ProcessRun& run : runs) {
    tables.push_back(increments_of(run));
    if (tables.back().empty()) continue;
    for (const auto& [name, value] : tables.back().back().extra) columns.insert(name);
    columns.erase("volume_loss");  // this column repeats the load parameter of the stage "volume_loss"
  }
  std::string text = "name,status,exit_code,stage,load_parameter,iterations,particle_steps,wall_s";
  for (const std::string& column : columns) text += "," + column;
  text += "\n";
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const ProcessRun& run = runs[k];
    const io::IncrementInfo last = tables[k].empty() ? io::IncrementInfo{} : tables[k].back();
    int iterations = 0;
    double steps = 0;
    double wall = 0;
    for (const io::IncrementInfo& info : tables[k]) {
      iterations += info.iterations;
      steps += info.particle_steps;
      wall += info.wall_s;
    }
    text += fmt::format("{},{},{},{},{:.9g},{},{:.9g},{:.2f}", run.name, name_of(run.end), run.end.code, last.stage,
                        last.load_parameter, iterations, steps, wall);
    for (const std::string& column : columns) {
      text += last.extra.contains(column) ? fmt::format(",{:.9g}", last.extra.at(column).value) : ",";
    }
    text += "\n";
  }
  io::write_text(file, text);
}

}  // namespace voussoir::host
