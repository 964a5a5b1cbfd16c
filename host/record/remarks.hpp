#pragma once
/// What a run says about its case before it begins.

#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "host/record/log.hpp"
#include "io/result_data.hpp"

namespace voussoir::host {

/// Writes the remarks about a case (Case::remarks) as warnings, to the log or, for kinds without one, to standard
/// output.
void say_remarks(const Case& input, RunLog& log);
void say_remarks(const Case& input);

/// Sentences about what may differ, and does, between a run and the process that goes on with it: the keys and settings
/// that change no number of a result, and the program itself, which may change the last bits.
[[nodiscard]] std::vector<std::string> resume_differences(const io::Provenance& begun, const io::Provenance& now);

}  // namespace voussoir::host
