#include "fem/mesh_gmsh_file.hpp"

#include <gmsh.h>

#include <algorithm>

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

GmshFile read_model() {
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

}  // namespace

GmshFile read_gmsh_file(const std::filesystem::path& path) {
  return call_gmsh(
      [&] {
        const GmshSession session;
        gmsh::merge(path.string());
        return read_model();
      },
      "");
}

}  // namespace voussoir::fem
