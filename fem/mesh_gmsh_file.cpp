#include "fem/mesh_gmsh_file.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cstdint>
#include <system_error>

#include "fem/mesh_gmsh_child.hpp"
#include "fem/mesh_gmsh_message.hpp"
#include "fem/mesh_gmsh_session.hpp"

namespace voussoir::fem {

namespace {

std::string group_name(int dimension, int tag) {
  std::string name;
  gmsh::model::getPhysicalName(dimension, tag, name);
  return name.empty() ? std::to_string(tag) : name;
}

void read_entity(int dimension, int tag, GmshFile& file) {
  std::vector<int> types, groups;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dimension, tag);
  gmsh::model::getPhysicalGroupsForEntity(dimension, tag, groups);
  std::sort(groups.begin(), groups.end());
  for (std::size_t t = 0; t < types.size(); ++t) {
    if (tags[t].empty()) continue;
    GmshBlock block;
    block.dimension = dimension;
    int of_type = 0, order = 0, corners = 0;
    std::vector<double> local;
    gmsh::model::mesh::getElementProperties(types[t], block.shape, of_type, order, block.nodes_each, local, corners);
    block.tags = tags[t];
    block.nodes = nodes[t];
    for (const int group : groups) {
      const std::string name = group_name(dimension, group);
      if (std::find(block.groups.begin(), block.groups.end(), name) == block.groups.end()) block.groups.push_back(name);
    }
    file.blocks.push_back(std::move(block));
  }
}

GmshFile read_model(const std::filesystem::path& path) {
  const GmshSession session;
  gmsh::merge(path.string());
  GmshFile file;
  std::vector<double> parametric;
  gmsh::model::mesh::getNodes(file.node_tags, file.positions, parametric);
  gmsh::vectorpair entities, groups;
  gmsh::model::getEntities(entities);
  for (const auto& [dimension, tag] : entities) read_entity(dimension, tag, file);
  gmsh::model::getPhysicalGroups(groups);
  std::sort(groups.begin(), groups.end());
  for (const auto& [dimension, tag] : groups) file.groups[dimension].push_back(group_name(dimension, tag));
  return file;
}

/// A file of n MB may take n seconds and 64 n MB of memory more than a small one: Gmsh and what it hands over need less
/// than a tenth of both.
ChildLimits limits_of(const std::filesystem::path& path, double seconds) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  const std::size_t megabytes = unknown ? 0 : static_cast<std::size_t>(size >> 20U);
  return {.seconds = seconds + static_cast<double>(megabytes), .bytes = (1024 + 64 * megabytes) << 20U};
}

}  // namespace

GmshFile read_gmsh_file(const std::filesystem::path& path, double seconds) {
  const auto read = [&] { return call_gmsh([&] { return bytes_of(read_model(path)); }, ""); };
  return gmsh_file_of(in_child(read, limits_of(path, seconds)));
}

}  // namespace voussoir::fem
