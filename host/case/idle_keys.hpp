#pragma once
/// The keys that a case may have and that its run does not use, with the condition of each.

#include "host/case/case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {

/// Declares the idle keys of a case whose tables have been read (io::Table::declare_idle). A key that counts only under
/// a condition has its row in the table of idle_keys.cpp, which is the one place of these conditions.
void declare_idle_keys(const io::Table& root, const Case& input);

}  // namespace voussoir::host
