#pragma once
/// The list of a sweep's runs as JSON, for programs that start them: `voussoir sweep --list --json`.

#include <string>
#include <utility>
#include <vector>

namespace voussoir::io {

struct ListedRun {
  std::string name = {};
  std::string folder = {};
  std::string case_file = {};  ///< absolute
  std::vector<std::string> overrides = {};
  std::string kind = {};
  std::vector<std::pair<std::string, std::string>> axes = {};
  std::string fingerprint = {};
  double memory = 0;     ///< estimate [B]
  double disk = 0;       ///< estimate [B]
  double core_time = 0;  ///< estimate [s]
};

struct ListedEnsemble {
  std::string name = {};
  std::vector<std::string> members = {};
};

/// {"folder", "runs": [{"name", "folder", "case", "set", "kind", "axes", "fingerprint", "memory_mb", "disk_mb",
/// "core_hours"}], "points": [{"name", "members"}]}
[[nodiscard]] std::string run_list_json(const std::string& folder, const std::vector<ListedRun>& runs,
                                        const std::vector<ListedEnsemble>& ensembles);

}  // namespace voussoir::io
