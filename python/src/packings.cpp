#include "python/src/packings.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <utility>

#include "host/case/load_case.hpp"
#include "host/case/made_with.hpp"
#include "host/library/accepted_case.hpp"
#include "host/library/grain_batch.hpp"
#include "host/packing/packings.hpp"
#include "host/packing/recipe.hpp"
#include "python/src/arrays.hpp"
#include "python/src/engine.hpp"

namespace voussoir::python {
namespace {

template <class T>
using Column = nb::ndarray<const T, nb::c_contig, nb::device::cpu>;

template <class T>
std::vector<T> column(const nb::dict& dict, const char* name) {
  const auto array = nb::cast<Column<T>>(dict[name]);
  return {array.data(), array.data() + array.size()};
}

/// The packings of these seeds, the lines of the log that tell of them, and those of them that say why a packing is
/// left out.
nb::tuple make_packings(const std::string& settings, const std::string& name, const std::vector<std::int64_t>& seeds,
                        bool stored) {
  std::vector<io::Packing> files;
  std::vector<std::string> notes, left_out;
  {
    const engine::Call call;
    const nb::gil_scoped_release free;
    const host::Case input = library::accepted(host::case_of_text(settings, name));
    const auto note = [&](const host::PackingLine& line) {
      notes.push_back(line);
      if (line.left_out) left_out.push_back(line);
    };
    std::vector<host::PackedRve> rves;
    engine::run_stoppable([&] {
      rves = stored ? host::obtain_packings(input.soil, input.packing, seeds, note, host::Bias::left)
                    : host::fresh_packings(input.soil, input.packing, seeds, note);
    });
    for (const host::PackedRve& rve : rves) {
      files.push_back(library::file_of({rve, input.soil}, host::recipe_text(input.soil, input.packing, rve.seed)));
    }
    notes.insert(notes.end(), input.remarks.begin(), input.remarks.end());
  }
  nb::list out;
  for (const io::Packing& file : files) out.append(dict_of(file));
  return nb::make_tuple(out, notes, left_out);
}

/// The labels "soil.*" of a packing that is made with these settings.
nb::dict soil_labels(const std::string& settings, const std::string& name) {
  nb::dict out;
  for (const auto& [key, text] : host::soil_keys(host::case_of_text(settings, name).soil)) out[key.c_str()] = text;
  return out;
}

}  // namespace

nb::dict dict_of(const io::Packing& packing) {
  nb::dict out;
  out["radius"] = array_of(packing.radius);
  out["x"] = array_of(packing.x);
  out["y"] = array_of(packing.y);
  out["rotation"] = array_of(packing.rotation);
  out["cell"] = array_of(std::vector<double>(packing.cell.begin(), packing.cell.end()), {2, 2});
  out["thickness"] = packing.thickness;
  out["contact_i"] = array_of(packing.contact_i);
  out["contact_j"] = array_of(packing.contact_j);
  out["history"] = array_of(packing.history, {packing.contacts(), packing.history_names.size()});
  out["history_names"] = packing.history_names;
  out["numbers"] = packing.numbers;
  out["labels"] = packing.labels;
  return out;
}

io::Packing packing_of(const nb::dict& dict) {
  io::Packing packing;
  packing.radius = column<double>(dict, "radius");
  packing.x = column<double>(dict, "x");
  packing.y = column<double>(dict, "y");
  packing.rotation = column<double>(dict, "rotation");
  const std::vector<double> cell = column<double>(dict, "cell");
  if (cell.size() != packing.cell.size()) throw nb::value_error("the cell of a packing has 2 x 2 numbers");
  std::copy(cell.begin(), cell.end(), packing.cell.begin());
  packing.thickness = nb::cast<double>(dict["thickness"]);
  packing.contact_i = column<std::int64_t>(dict, "contact_i");
  packing.contact_j = column<std::int64_t>(dict, "contact_j");
  packing.history = column<double>(dict, "history");
  packing.history_names = nb::cast<std::vector<std::string>>(dict["history_names"]);
  packing.numbers = nb::cast<std::map<std::string, double>>(dict["numbers"]);
  packing.labels = nb::cast<std::map<std::string, std::string>>(dict["labels"]);
  return packing;
}

void bind_packings(nb::module_& module) {
  module.def(
      "make_packings", &make_packings, nb::arg("settings"), nb::arg("name"), nb::arg("seeds"), nb::arg("stored"),
      "Packings of a case of the kind pack as dictionaries, the lines of its log, and those of them that say why a "
      "packing is left out.");
  module.def("soil_labels", &soil_labels, nb::arg("settings"), nb::arg("name"),
             "The labels soil.* of a packing that is made with these settings.");
  module.def(
      "check_packing", [](const nb::dict& dict) { static_cast<void>(library::grains_of(packing_of(dict))); },
      nb::arg("packing"), "ValueError where a dictionary is no complete packing of this contact law.");
  module.def(
      "content_of", [](const nb::dict& dict) { return io::content_of(packing_of(dict)); }, nb::arg("packing"),
      "The checksum that a packing file keeps as its attribute `content`.");
  module.def("publish", &publish, nb::arg("path"), nb::arg("image"),
             "Writes the image of an HDF5 file, completely or not at all.");
}

}  // namespace voussoir::python
