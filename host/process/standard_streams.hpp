#pragma once
/// Standard input, output and error as a pipe, a full disk or a closed descriptor leave them.

#include <optional>
#include <string>

namespace voussoir::host {

/// To be called first in `main`. Descriptors 0 to 2 that are closed are taken up, so that no result file gets their
/// numbers and with them the lines of the report; writing to them still fails. A pipe without a reader (SIGPIPE) and a
/// file beyond its limit (SIGXFSZ) become failures of the call that writes.
void prepare_standard_streams();

/// Writes the answer of a command whose product is its output. Returns false where that fails, after one line on
/// standard error; no line is written where the reader of a pipe has gone, as `head` does.
[[nodiscard]] bool print_answer(const std::string& answer);

/// For a command whose product is its files: the reason for which standard output has failed, if it has. Whatever is
/// written to it from then on is dropped in silence.
[[nodiscard]] std::optional<std::string> lost_output();

}  // namespace voussoir::host
