#include "io/result_parts.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace voussoir::io {

namespace {

/// Calls visit(name, member) for the texts that every provenance has. These and the texts of for_each_later_text are
/// its attributes.
template <class Source, class Visit>
void for_each_text(Source& source, Visit&& visit) {
  visit("case_kind", source.case_kind);
  visit("fingerprint", source.fingerprint);
  visit("version", source.version);
  visit("git_hash", source.git_hash);
  visit("kokkos", source.kokkos);
  visit("command", source.command);
  visit("date", source.date);
}

/// The same for texts that files of the first versions lack.
template <class Source, class Visit>
void for_each_later_text(Source& source, Visit&& visit) {
  visit("build_compiler", source.build_compiler);
  visit("build_type", source.build_type);
  visit("processor", source.processor);
  visit("lanes", source.lanes);
  visit("device", source.device);
}

}  // namespace

void write_provenance(Hdf5File& file, const Provenance& provenance) {
  file.write_text("/input", provenance.input);
  file.make_group("/provenance");
  const auto write = [&](const char* name, const std::string& text) { file.set_attribute("/provenance", name, text); };
  for_each_text(provenance, write);
  for_each_later_text(provenance, write);
  file.set_attribute("/provenance", "threads", std::int64_t{provenance.threads});
  file.set_attribute("/provenance", "ranks", std::int64_t{provenance.ranks});
}

void write_mesh(Hdf5File& file, const MeshData& mesh) {
  file.write("/mesh/coordinates", mesh.coordinates, {mesh.nodes(), 2}, "m");
  file.write("/mesh/connectivity", mesh.connectivity, {mesh.elements(), 8}, "-");
  file.make_group("/mesh/boundaries");
  for (const auto& [name, nodes] : mesh.boundaries) {
    file.write("/mesh/boundaries/" + name, nodes, {nodes.size()}, "-");
  }
  if (!mesh.points.empty()) file.make_group("/mesh/points");
  for (const auto& [name, node] : mesh.points) {
    file.set_attribute("/mesh/points", name, node);
  }
  file.make_group("/mesh/geometry");
  for (const auto& [name, value] : mesh.geometry) {
    file.set_attribute("/mesh/geometry", name, value);
  }
  if (!mesh.regions.empty()) {
    file.write("/mesh/regions", mesh.regions, {mesh.regions.size()}, "-");
    file.write_texts("/mesh/region_names", mesh.region_names);
  }
}

Provenance read_provenance(const Hdf5File& file) {
  Provenance provenance;
  provenance.input = file.read_text("/input");
  const auto read = [&](const char* name, std::string& text) { text = file.text_attribute("/provenance", name); };
  for_each_text(provenance, read);
  const std::vector<std::string> names = file.attributes("/provenance");
  const auto has = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  for_each_later_text(provenance, [&](const char* name, std::string& text) {
    if (has(name)) read(name, text);
  });
  provenance.threads = static_cast<int>(file.integer_attribute("/provenance", "threads"));
  if (has("ranks")) {  // files of the first versions lack this number too
    provenance.ranks = static_cast<int>(file.integer_attribute("/provenance", "ranks"));
  }
  return provenance;
}

}  // namespace voussoir::io
