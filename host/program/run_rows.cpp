#include "host/program/run_rows.hpp"

#include <cstdio>
#include <exception>

#include "host/sweep/run_results.hpp"
#include "io/atomic_file.hpp"

namespace voussoir::host {

io::SweepRow row_of(const ProcessRun& run) {
  io::SweepRow row{.name = run.name, .status = name_of(run.end), .exit_code = run.end.code, .reason = run.reason};
  try {
    add_results(row, run.folder);
  } catch (const std::exception& damage) {
    std::fprintf(stderr, "voussoir: the summary has no values of %s: %s\n", run.name.c_str(), damage.what());
  }
  return row;
}

void write_summary(std::span<const ProcessRun> runs, const std::filesystem::path& file) {
  std::vector<io::SweepRow> rows;
  for (const ProcessRun& run : runs) rows.push_back(row_of(run));
  io::write_text(file, io::summary_csv(rows));
}

}  // namespace voussoir::host
