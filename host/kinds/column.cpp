#include "host/kinds/column.hpp"

#include "host/record/provenance.hpp"
#include "host/record/remarks.hpp"

namespace voussoir::host {

RunStatus run_column(const Case& input, const RunOptions& options) {
  RunLog log = open_log(options);
  tell_circumstances(options, log);
  log_engine(input, log);
  say_remarks(input, log);
  const ColumnResult column = measure_k0(column_setup(input), options, provenance_of(options, input, "column"), log);
  for (const std::string& line : totals_table(column.totals)) log.line(line);
  return column.status;
}

}  // namespace voussoir::host
