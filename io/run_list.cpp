#include "io/run_list.hpp"

#include <nlohmann/json.hpp>

namespace voussoir::io {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const ListedRun& run) {
  constexpr double megabyte = 1e6, hour = 3600;
  Json axes = Json::object();
  for (const auto& [name, value] : run.axes) axes[name] = value;
  return {{"name", run.name},
          {"folder", run.folder},
          {"case", run.case_file},
          {"set", run.overrides},
          {"kind", run.kind},
          {"axes", axes},
          {"fingerprint", run.fingerprint},
          {"memory_mb", run.memory / megabyte},
          {"disk_mb", run.disk / megabyte},
          {"core_hours", run.core_time / hour}};
}

}  // namespace

std::string run_list_json(const std::string& folder, const std::vector<ListedRun>& runs,
                          const std::vector<ListedEnsemble>& ensembles) {
  Json list{{"folder", folder}, {"runs", Json::array()}, {"points", Json::array()}};
  for (const ListedRun& run : runs) list["runs"].push_back(json_of(run));
  for (const ListedEnsemble& ensemble : ensembles)
    list["points"].push_back(Json{{"name", ensemble.name}, {"members", ensemble.members}});
  return list.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace voussoir::io
