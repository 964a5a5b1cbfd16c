/// XDMF 2: the text that tells ParaView where the datasets of an increment are. The numbers stay in HDF5.

#include <fmt/format.h>

#include "io/hdf5.hpp"
#include "io/increment_file.hpp"

namespace voussoir::io {

namespace {

std::string data_item(const std::string& dimensions, const char* type, const std::string& source) {
  return fmt::format(R"(<DataItem Format="HDF" NumberType="{}" Precision="8" Dimensions="{}">{}</DataItem>)", type,
                     dimensions, source);
}

std::string attribute(const std::string& name, const char* type, const char* center, const std::string& item) {
  return fmt::format(
      "        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n          {}\n        </Attribute>\n", name,
      type, center, item);
}

std::string attributes(const Hdf5File& file, const std::string& source, const std::string& group, const char* center) {
  std::string out;
  for (const auto& name : file.members("/xdmf/" + group)) {
    const std::string object = fmt::format("/xdmf/{}/{}", group, name);
    const auto shape = file.shape(object);
    const bool vector = shape.size() == 2;
    const std::string dimensions = vector ? fmt::format("{} {}", shape[0], shape[1]) : fmt::format("{}", shape[0]);
    out += attribute(name, vector ? "Vector" : "Scalar", center,
                     data_item(dimensions, "Float", fmt::format("{}:{}", source, object)));
  }
  return out;
}

}  // namespace

std::string xdmf_grid(const std::filesystem::path& path, const MeshData& mesh, const IncrementInfo& info) {
  const Hdf5File file = Hdf5File::open(path);
  const std::string source = fmt::format("increments/{}", path.filename().string());
  const std::string geometry = file.has("/mesh/coordinates") ? source + ":/mesh/coordinates"
                                                             : "run.h5:/mesh/coordinates";
  std::string out = fmt::format("      <Grid Name=\"{}_{}\" GridType=\"Uniform\">\n", info.stage, info.stage_index);
  out += fmt::format("        <Time Value=\"{}\"/>\n", info.index);
  out += fmt::format(
      "        <Topology TopologyType=\"Quadrilateral_8\" NumberOfElements=\"{}\">\n          {}\n        "
      "</Topology>\n",
      mesh.elements(), data_item(fmt::format("{} 8", mesh.elements()), "Int", "run.h5:/mesh/connectivity"));
  out += fmt::format("        <Geometry GeometryType=\"XY\">\n          {}\n        </Geometry>\n",
                     data_item(fmt::format("{} 2", mesh.nodes()), "Float", geometry));
  out += attributes(file, source, "node", "Node");
  out += attributes(file, source, "cell", "Cell");
  if (!mesh.regions.empty()) {
    out += attribute("region", "Scalar", "Cell",
                     data_item(fmt::format("{}", mesh.elements()), "Int", "run.h5:/mesh/regions"));
  }
  return out + "      </Grid>\n";
}

std::string xdmf_document(const std::vector<std::string>& grids) {
  std::string out =
      "<?xml version=\"1.0\" ?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf Version=\"2.0\">\n  <Domain>\n"
      "    <Grid Name=\"result\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const auto& grid : grids) {
    out += grid;
  }
  return out + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

}  // namespace voussoir::io
