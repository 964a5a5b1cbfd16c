// The two functions that read and write packings as HDF5 files. The Python module has its own two, which call h5py
// (python/src/packing_files.cpp), so that it links no HDF5 library.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "io/hdf5.hpp"
#include "io/packing_file.hpp"

namespace voussoir::io {

namespace {

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    parts.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

void write_packing(Hdf5File& file, const Packing& packing) {
  const std::vector<std::size_t> grains{packing.grains()};
  const std::vector<std::size_t> contacts{packing.contacts()};
  file.set_attribute("/", "format", std::string(packing_format));
  file.set_attribute("/", "format_version", packing_format_version);
  file.set_attribute("/", "thickness", packing.thickness);
  file.set_attribute("/", "content", content_of(packing));
  file.write("/radius", packing.radius, grains, "m");
  file.write("/x", packing.x, grains, "m");
  file.write("/y", packing.y, grains, "m");
  file.write("/rotation", packing.rotation, grains, "rad");
  file.write("/cell", packing.cell, {2, 2}, "m");
  file.write("/contact_i", packing.contact_i, contacts, "-");
  file.write("/contact_j", packing.contact_j, contacts, "-");
  file.write("/history", packing.history, {packing.contacts(), packing.history_names.size()}, "SI");
  file.set_attribute("/history", "names", fmt::format("{}", fmt::join(packing.history_names, ",")));
  file.make_group("/numbers");
  for (const auto& [name, value] : packing.numbers) {
    file.set_attribute("/numbers", name, value);
  }
  file.make_group("/labels");
  for (const auto& [name, value] : packing.labels) {
    file.set_attribute("/labels", name, value);
  }
}

}  // namespace

void save_packing(const std::filesystem::path& path, const Packing& packing) {
  const std::string problem = disagreement_of(packing);
  if (!problem.empty()) {
    throw std::invalid_argument(fmt::format("packing for {}: {}", path.string(), problem));
  }
  if (path.has_parent_path()) {
    std::filesystem::create_directories(path.parent_path());
  }
  Hdf5File file = Hdf5File::create(path);
  write_packing(file, packing);
  file.publish();
}

Packing load_packing(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open(path);
  file.require_format(packing_format, packing_format_version, "a packing");
  Packing packing;
  packing.thickness = file.number_attribute("/", "thickness");
  packing.radius = file.read_doubles("/radius").values;
  packing.x = file.read_doubles("/x").values;
  packing.y = file.read_doubles("/y").values;
  packing.rotation = file.read_doubles("/rotation").values;
  const auto cell = file.read_doubles("/cell").values;
  if (cell.size() != packing.cell.size()) {
    throw std::runtime_error(fmt::format("{}: the cell has {} numbers instead of 4", path.string(), cell.size()));
  }
  std::copy(cell.begin(), cell.end(), packing.cell.begin());
  packing.contact_i = file.read_integers("/contact_i").values;
  packing.contact_j = file.read_integers("/contact_j").values;
  packing.history = file.read_doubles("/history").values;
  packing.history_names = split(file.text_attribute("/history", "names"));
  for (const auto& name : file.attributes("/numbers")) {
    packing.numbers[name] = file.number_attribute("/numbers", name);
  }
  for (const auto& name : file.attributes("/labels")) {
    packing.labels[name] = file.text_attribute("/labels", name);
  }
  const std::vector<std::string> known = file.attributes("/");
  const bool tells = std::find(known.begin(), known.end(), "content") != known.end();  // older files do not
  require_agreement(path, packing, tells ? std::optional(file.integer_attribute("/", "content")) : std::nullopt);
  return packing;
}

}  // namespace voussoir::io
