#include "host/record/remarks.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <stdexcept>

#include "io/case_compare.hpp"

namespace voussoir::host {

void say_remarks(const Case& input, RunLog& log) {
  for (const std::string& remark : input.remarks) log.warning(remark);
}

void say_remarks(const Case& input) {
  for (const std::string& remark : input.remarks) std::printf("warning: %s\n", remark.c_str());
}

std::vector<std::string> resume_differences(const io::Provenance& begun, const io::Provenance& now) {
  std::vector<std::string> lines;
  const auto compare = [&](const char* what, const auto& before, const auto& after, const char* effect) {
    if (before != after) {
      lines.push_back(
          fmt::format("{}: this process has {}, the run was begun with {}; {}", what, after, before, effect));
    }
  };
  constexpr const char* no_number = "the two may differ, because no number depends on it";
  constexpr const char* last_bits = "the two may differ, but the last bits of the results may then differ, too";
  try {
    for (const io::KeyDifference& d : io::differences(now.input, begun.input))
      compare(d.key.c_str(), d.theirs, d.ours, no_number);
    // NOLINTNEXTLINE(bugprone-empty-catch): an old file may hold no resolved case; its fingerprint has been compared.
  } catch (const std::runtime_error&) {
  }
  compare("threads", begun.threads, now.threads, no_number);
  compare("ranks", begun.ranks, now.ranks, no_number);
  compare("the lanes", begun.lanes, now.lanes, no_number);
  compare("the program", begun.version + " (" + begun.git_hash + ")", now.version + " (" + now.git_hash + ")",
          last_bits);
  compare("the compiler", begun.build_compiler, now.build_compiler, last_bits);
  compare("Kokkos", begun.kokkos, now.kokkos, last_bits);
  return lines;
}

}  // namespace voussoir::host
