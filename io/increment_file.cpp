#include "io/increment_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <set>
#include <stdexcept>

#include "io/hdf5.hpp"

namespace voussoir::io {

namespace {

constexpr std::size_t gauss_points = 4;
constexpr const char* format_name = "voussoir increment";
constexpr std::int64_t format_version = 1;
const std::set<std::string> no_columns{"format", "format_version", "case_kind", "fingerprint", "stage"};

struct Location {
  FieldLocation location;
  const char* group;
};
constexpr std::array locations{Location{FieldLocation::node, "node"}, Location{FieldLocation::gauss, "gauss"},
                               Location{FieldLocation::element, "element"}, Location{FieldLocation::rve, "rve"}};

void write_info(Hdf5File& file, const Provenance& run, const IncrementInfo& info) {
  file.set_attribute("/", "format", std::string(format_name));
  file.set_attribute("/", "format_version", format_version);
  file.set_attribute("/", "case_kind", run.case_kind);
  file.set_attribute("/", "fingerprint", run.fingerprint);
  file.set_attribute("/", "stage", info.stage);
  file.make_group("/units");
  for_each_number(info, [&](const char* name, const char* unit, auto value) {
    file.set_attribute("/units", name, std::string(unit));
    if constexpr (std::floating_point<decltype(value)>) {
      file.set_attribute("/", name, value);
    } else {
      file.set_attribute("/", name, static_cast<std::int64_t>(value));
    }
  });
  for (const auto& [name, quantity] : info.extra) {
    file.set_attribute("/", name, quantity.value);
    file.set_attribute("/units", name, quantity.unit);
  }
  if (!info.residual_history.empty()) {
    file.write("/convergence/residual", info.residual_history, {info.residual_history.size()}, "-");
  }
}

/// Returns one row per element, the mean over its points; `values` is (element, 4, components).
std::vector<double> element_means(const Field& field) {
  const auto components = static_cast<std::size_t>(field.components);
  std::vector<double> means(field.values.size() / gauss_points, 0.0);
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    const std::size_t element = i / (gauss_points * components);
    means[element * components + i % components] += field.values[i] / static_cast<double>(gauss_points);
  }
  return means;
}

/// Writes copies for VTK's XDMF reader, which knows only scalars, and vectors with three components.
void write_xdmf_copies(Hdf5File& file, const Field& field) {
  const auto components = static_cast<std::size_t>(field.components);
  const bool nodal = field.location == FieldLocation::node;
  const std::vector<double> rows = field.location == FieldLocation::gauss ? element_means(field) : field.values;
  const std::size_t count = rows.size() / components;
  const std::string name = fmt::format("/xdmf/{}/{}", nodal ? "node" : "cell", field.name);
  if (components == 2) {
    std::vector<double> vectors(3 * count, 0.0);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      vectors[3 * (i / 2) + i % 2] = rows[i];
    }
    file.write(name, vectors, {count, 3}, field.unit);
    return;
  }
  constexpr std::array tensor{"_xx", "_yy", "_xy"};
  for (std::size_t k = 0; k < components; ++k) {
    std::vector<double> scalars(count);
    for (std::size_t i = 0; i < count; ++i) {
      scalars[i] = rows[i * components + k];
    }
    const std::string suffix = components == 3 ? tensor[k] : fmt::format("_{}", k);
    file.write(components == 1 ? name : name + suffix, scalars, {count}, field.unit);
  }
}

void write_snapshot(Hdf5File& file, const RveSnapshot& snapshot) {
  const std::string group = fmt::format("/snapshots/{}", snapshot.name);
  const std::vector<std::size_t> grains{snapshot.x.size()};
  const std::size_t contacts = snapshot.contact_i.size();
  file.write(group + "/cell", snapshot.cell, {2, 2}, "m");
  file.write(group + "/x", snapshot.x, grains, "m");
  file.write(group + "/y", snapshot.y, grains, "m");
  file.write(group + "/radius", snapshot.radius, grains, "m");
  file.write(group + "/rotation", snapshot.rotation, grains, "rad");
  file.write(group + "/contact_i", snapshot.contact_i, {contacts}, "-");
  file.write(group + "/contact_j", snapshot.contact_j, {contacts}, "-");
  file.write(group + "/branch", snapshot.branch, {contacts, 2}, "m");
  file.write(group + "/force", snapshot.force, {contacts, 2}, "N");
  file.set_attribute(group, "thickness", snapshot.thickness);
}

RveSnapshot read_snapshot(const Hdf5File& file, const std::string& name) {
  const std::string group = fmt::format("/snapshots/{}", name);
  RveSnapshot snapshot{.name = name};
  const auto cell = file.read_doubles(group + "/cell").values;
  std::copy_n(cell.begin(), std::min(cell.size(), snapshot.cell.size()), snapshot.cell.begin());
  snapshot.x = file.read_doubles(group + "/x").values;
  snapshot.y = file.read_doubles(group + "/y").values;
  snapshot.radius = file.read_doubles(group + "/radius").values;
  snapshot.rotation = file.read_doubles(group + "/rotation").values;
  snapshot.contact_i = file.read_integers(group + "/contact_i").values;
  snapshot.contact_j = file.read_integers(group + "/contact_j").values;
  snapshot.branch = file.read_doubles(group + "/branch").values;
  snapshot.force = file.read_doubles(group + "/force").values;
  snapshot.thickness = file.number_attribute(group, "thickness");
  return snapshot;
}

Field read_field(const Hdf5File& file, FieldLocation location, const std::string& name) {
  const std::string object = fmt::format("/{}/{}", group_of(location), name);
  auto array = file.read_doubles(object);
  return {.name = name,
          .unit = file.text_attribute(object, "unit"),
          .location = location,
          .components = static_cast<int>(array.shape.back()),
          .values = std::move(array.values)};
}

}  // namespace

const char* group_of(FieldLocation location) {
  return std::find_if(locations.begin(), locations.end(), [&](const Location& l) { return l.location == location; })
      ->group;
}

std::vector<std::size_t> shape_of(const Field& field) {
  const auto components = static_cast<std::size_t>(field.components);
  const std::size_t rows = field.values.size() / components;
  if (field.location == FieldLocation::gauss) {
    return {rows / gauss_points, gauss_points, components};
  }
  return {rows, components};
}

void write_increment_file(const std::filesystem::path& path, const Provenance& run, const MeshData& mesh,
                          const IncrementInfo& info, const std::vector<Field>& fields,
                          const std::vector<RveSnapshot>& snapshots, const std::vector<double>& coordinates) {
  Hdf5File file = Hdf5File::create(path);
  write_info(file, run, info);
  if (!coordinates.empty()) {
    file.write("/mesh/coordinates", coordinates, {mesh.nodes(), 2}, "m");
  }
  for (const Field& field : fields) {
    file.write(fmt::format("/{}/{}", group_of(field.location), field.name), field.values, shape_of(field), field.unit);
    if (field.location != FieldLocation::rve) {
      write_xdmf_copies(file, field);
    }
  }
  for (const RveSnapshot& snapshot : snapshots) {
    write_snapshot(file, snapshot);
  }
  file.publish();
}

/// Throws where the file says that it is another run's.
void require_run(const Hdf5File& file, const std::vector<std::string>& names, const std::filesystem::path& path,
                 const Provenance& run) {
  const auto require = [&](const char* name, const std::string& wanted) {
    if (std::find(names.begin(), names.end(), name) == names.end()) return;
    const std::string found = file.text_attribute("/", name);
    if (found != wanted) {
      throw std::runtime_error(fmt::format("{}: it is the file of another run, whose {} is {} and not {}",
                                           path.string(), name, found, wanted));
    }
  };
  require("case_kind", run.case_kind);
  require("fingerprint", run.fingerprint);
}

bool is_increment_file(const std::filesystem::path& path) {
  try {
    Hdf5File::open(path).require_format(format_name, format_version, "an increment of a result");
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

IncrementInfo read_increment_info(const std::filesystem::path& path, const Provenance& run) {
  const Hdf5File file = Hdf5File::open(path);
  file.require_format(format_name, format_version, "an increment of a result");
  file.read_through("/");
  const std::vector<std::string> names = file.attributes("/");
  require_run(file, names, path, run);
  IncrementInfo info;
  info.stage = file.text_attribute("/", "stage");
  std::set<std::string> known = no_columns;
  for_each_number(info, [&](const char* name, const char*, auto& value) {
    using Value = std::remove_reference_t<decltype(value)>;
    known.insert(name);
    if constexpr (std::floating_point<Value>) {
      value = file.number_attribute("/", name);
    } else {
      value = static_cast<Value>(file.integer_attribute("/", name));
    }
  });
  for (const auto& name : names) {
    if (!known.contains(name)) {
      info.extra[name] = {file.number_attribute("/", name), file.text_attribute("/units", name)};
    }
  }
  if (fmt::format("{:04}", info.index) != path.stem().string()) {
    throw std::runtime_error(
        fmt::format("{}: it is a copy of increment {}, under the name of another one", path.string(), info.index));
  }
  if (file.has("/convergence/residual")) {
    info.residual_history = file.read_doubles("/convergence/residual").values;
  }
  return info;
}

std::vector<Field> read_fields(const std::filesystem::path& increment_file) {
  const Hdf5File file = Hdf5File::open(increment_file);
  std::vector<Field> fields;
  for (const auto& [location, group] : locations) {
    for (const auto& name : file.members(fmt::format("/{}", group))) {
      fields.push_back(read_field(file, location, name));
    }
  }
  return fields;
}

std::optional<Field> find_field(const std::filesystem::path& increment_file, FieldLocation location,
                                const std::string& name) {
  const Hdf5File file = Hdf5File::open(increment_file);
  if (!file.has(fmt::format("/{}/{}", group_of(location), name))) return std::nullopt;
  return read_field(file, location, name);
}

std::vector<RveSnapshot> read_snapshots(const std::filesystem::path& increment_file) {
  const Hdf5File file = Hdf5File::open(increment_file);
  std::vector<RveSnapshot> snapshots;
  for (const auto& name : file.members("/snapshots")) {
    snapshots.push_back(read_snapshot(file, name));
  }
  return snapshots;
}

}  // namespace voussoir::io
