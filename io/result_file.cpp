#include "io/result_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <concepts>
#include <limits>
#include <stdexcept>

#include "io/atomic_file.hpp"
#include "io/hdf5.hpp"
#include "io/increment_file.hpp"
#include "io/result_parts.hpp"

namespace voussoir::io {

namespace {

constexpr const char* format_name = "voussoir run";
constexpr std::int64_t format_version = 1;
namespace fs = std::filesystem;

void write_tables(Hdf5File& file, const Tables& tables) {
  file.make_group("/tables");
  for (const auto& [table, columns] : tables) {
    for (const TableColumn& column : columns) {
      file.write(fmt::format("/tables/{}/{}", table, column.name), column.values, {column.values.size()}, column.unit);
    }
  }
}

/// Writes the columns of all increments. An increment that has no value for an extra column gets NaN.
void write_increment_table(Hdf5File& file, const std::vector<IncrementInfo>& increments) {
  const std::vector<std::size_t> rows{increments.size()};
  file.make_group("/table");
  std::map<std::string, std::pair<std::string, std::vector<double>>> reals;
  std::map<std::string, std::vector<std::int64_t>> integers;
  std::map<std::string, std::string> extra;  // name, unit
  std::vector<std::string> stages;
  for (const auto& info : increments) {
    stages.push_back(info.stage);
    for_each_number(info, [&](const char* name, const char* unit, auto value) {
      if constexpr (std::floating_point<decltype(value)>) {
        reals[name].first = unit;
        reals[name].second.push_back(value);
      } else {
        integers[name].push_back(static_cast<std::int64_t>(value));
      }
    });
    for (const auto& [name, quantity] : info.extra) {
      extra[name] = quantity.unit;
    }
  }
  for (const auto& [name, unit] : extra) {
    for (const auto& info : increments) {
      const auto found = info.extra.find(name);
      reals[name].second.push_back(found == info.extra.end() ? std::numeric_limits<double>::quiet_NaN()
                                                             : found->second.value);
    }
    reals[name].first = unit;
  }
  for (const auto& [name, column] : reals) {
    file.write("/table/" + name, column.second, rows, column.first);
  }
  for (const auto& [name, column] : integers) {
    file.write("/table/" + name, column, rows, "-");
  }
  file.write_texts("/table/stage", stages);
}

}  // namespace

std::filesystem::path increment_path(const std::filesystem::path& folder, int index) {
  return folder / "increments" / fmt::format("{:04}.h5", index);
}

std::vector<int> list_increments(const std::filesystem::path& folder) {
  std::vector<int> found;
  if (fs::is_directory(folder / "increments")) {
    for (const auto& entry : fs::directory_iterator(folder / "increments")) {
      const std::string name = entry.path().filename().string();
      int index = -1;
      std::from_chars(name.data(), name.data() + name.size(), index);
      if (index >= 0 && increment_path(folder, index).filename() == name) {
        found.push_back(index);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

ResultWriter::ResultWriter(std::filesystem::path folder, Provenance provenance, MeshData mesh)
    : folder_(std::move(folder)), provenance_(std::move(provenance)), mesh_(std::move(mesh)) {
  // The folder itself is there, and where somebody has just moved it away, it must not come up again under its old
  // name.
  fs::create_directory(folder_ / "increments");
  remove_leftovers(folder_ / "increments");
  remove_leftovers(folder_);
}

ResultWriter ResultWriter::create(const std::filesystem::path& folder, Provenance provenance, MeshData mesh) {
  return resume(folder, std::move(provenance), std::move(mesh), -1);
}

ResultWriter ResultWriter::resume(const std::filesystem::path& folder, Provenance provenance, MeshData mesh, int last) {
  ResultWriter writer(folder, std::move(provenance), std::move(mesh));
  for (const int index : list_increments(folder)) {
    const auto path = increment_path(folder, index);
    if (index > last) {
      fs::remove(path);
      continue;
    }
    try {
      writer.increments_.push_back(read_increment_info(path, writer.provenance_));
      writer.grids_.push_back(xdmf_grid(path, writer.mesh_, writer.increments_.back()));
    } catch (const std::exception& damage) {
      throw std::runtime_error(std::string(damage.what()) +
                               "; where this file is removed, --resume goes on without this increment's results");
    }
  }
  if (writer.mesh_.nodes() == 0) {
    fs::remove(folder / "result.xdmf");
  }
  if (last >= 0 && fs::exists(folder / "run.h5")) {
    writer.tables_ = read_tables(folder / "run.h5");
  }
  writer.write_index();
  return writer;
}

void ResultWriter::check(const Field& field) const {
  const std::size_t rows[] = {mesh_.nodes(), 4 * mesh_.elements(), mesh_.elements()};
  const auto components = static_cast<std::size_t>(std::max(field.components, 1));
  const bool free_rows = field.location == FieldLocation::rve;
  const std::size_t expected = free_rows ? field.values.size() / components * components
                                         : rows[static_cast<std::size_t>(field.location)] * components;
  if (field.name.empty() || field.name.find('/') != std::string::npos || field.components < 1 ||
      field.values.size() != expected) {
    throw std::invalid_argument(fmt::format("field \"{}\" has {} values of {} components, expected {}", field.name,
                                            field.values.size(), field.components, expected));
  }
}

void ResultWriter::write(const IncrementInfo& info, const std::vector<Field>& fields,
                         const std::vector<RveSnapshot>& snapshots, const std::vector<double>& coordinates) {
  if (info.index < 0 || (!increments_.empty() && info.index <= increments_.back().index)) {
    throw std::invalid_argument(
        fmt::format("increment {} does not follow the increments that are written", info.index));
  }
  if (!coordinates.empty() && coordinates.size() != mesh_.coordinates.size()) {
    throw std::invalid_argument(
        fmt::format("there are {} coordinates for {} nodes", coordinates.size() / 2, mesh_.nodes()));
  }
  for (const Field& field : fields) {
    check(field);
  }
  const auto path = increment_path(folder_, info.index);
  write_increment_file(path, provenance_, mesh_, info, fields, snapshots, coordinates);
  increments_.push_back(info);
  grids_.push_back(xdmf_grid(path, mesh_, info));
  write_index();
}

void ResultWriter::set_table(const std::string& name, std::vector<TableColumn> columns) {
  const auto usable = [](const std::string& text) { return !text.empty() && text.find('/') == std::string::npos; };
  const bool fits = !columns.empty() && std::all_of(columns.begin(), columns.end(), [&](const TableColumn& column) {
    return usable(column.name) && column.values.size() == columns.front().values.size();
  });
  if (!usable(name) || !fits) {
    throw std::invalid_argument(
        fmt::format("table \"{}\": its names or the lengths of its columns cannot be used", name));
  }
  tables_[name] = std::move(columns);
  write_index();
}

void ResultWriter::write_index() const {
  Hdf5File file = Hdf5File::create(folder_ / "run.h5");
  file.set_attribute("/", "format", std::string(format_name));
  file.set_attribute("/", "format_version", format_version);
  write_provenance(file, provenance_);
  if (mesh_.nodes() > 0) {
    write_mesh(file, mesh_);
  }
  file.make_group("/increments");
  for (const auto& info : increments_) {
    const std::string name = increment_path({}, info.index).filename().stem().string();
    file.link_external("/increments/" + name, fmt::format("increments/{}.h5", name), "/");
  }
  write_increment_table(file, increments_);
  write_tables(file, tables_);
  file.publish();
  if (mesh_.nodes() > 0) {
    write_text(folder_ / "result.xdmf", xdmf_document(grids_));
  }
}

Provenance read_provenance(const std::filesystem::path& run_file) {
  const Hdf5File file = Hdf5File::open(run_file);
  file.require_format(format_name, format_version, "the result of a run");
  return read_provenance(file);
}

MeshData read_mesh(const std::filesystem::path& run_file) {
  const Hdf5File file = Hdf5File::open(run_file);
  MeshData mesh;
  if (!file.has("/mesh")) {
    return mesh;
  }
  mesh.coordinates = file.read_doubles("/mesh/coordinates").values;
  mesh.connectivity = file.read_integers("/mesh/connectivity").values;
  for (const auto& name : file.members("/mesh/boundaries")) {
    mesh.boundaries.emplace_back(name, file.read_integers("/mesh/boundaries/" + name).values);
  }
  if (file.has("/mesh/points")) {
    for (const auto& name : file.attributes("/mesh/points")) {
      mesh.points[name] = file.integer_attribute("/mesh/points", name);
    }
  }
  for (const auto& name : file.attributes("/mesh/geometry")) {
    mesh.geometry[name] = file.number_attribute("/mesh/geometry", name);
  }
  if (file.has("/mesh/regions")) {
    mesh.regions = file.read_integers("/mesh/regions").values;
    mesh.region_names = file.read_texts("/mesh/region_names");
  }
  return mesh;
}

Tables read_tables(const std::filesystem::path& run_file) {
  const Hdf5File file = Hdf5File::open(run_file);
  Tables tables;
  for (const auto& table : file.members("/tables")) {
    for (const auto& column : file.members("/tables/" + table)) {
      const std::string object = fmt::format("/tables/{}/{}", table, column);
      tables[table].push_back({column, file.text_attribute(object, "unit"), file.read_doubles(object).values});
    }
  }
  return tables;
}

std::vector<IncrementInfo> read_increments(const std::filesystem::path& run_file) {
  // The folder is read and not the table of run.h5, because a kill between the two renames leaves an increment that the
  // table lacks.
  const auto folder = run_file.parent_path();
  const Provenance run = read_provenance(run_file);
  std::vector<IncrementInfo> increments;
  for (const int index : list_increments(folder)) {
    increments.push_back(read_increment_info(increment_path(folder, index), run));
  }
  return increments;
}

}  // namespace voussoir::io
