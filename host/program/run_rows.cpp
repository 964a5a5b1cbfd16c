#include "host/program/run_rows.hpp"

#include <cstdio>
#include <exception>

#include "host/sweep/run_results.hpp"

namespace voussoir::host {

ReadRun read_run(ProcessRun& run) {
  ReadRun read;
  io::SweepRow& row = read.row;
  try {
    if (run.end.outcome != Outcome::wrong_input) read.results = add_results(row, run.folder);
  } catch (const std::exception& damage) {
    std::fprintf(stderr, "voussoir: the summary has no values of %s: %s\n", run.name.c_str(), damage.what());
    if (run.end.outcome == Outcome::done || run.end.outcome == Outcome::no_equilibrium) {
      run.end = end_of_code(exit_code(Outcome::machine_failure));
      run.reason = damage.what();
    }
  }
  row.name = run.name;
  row.status = name_of(run.end);
  row.exit_code = run.end.code;
  row.reason = run.reason;
  return read;
}

}  // namespace voussoir::host
