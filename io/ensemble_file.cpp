#include "io/ensemble_file.hpp"

#include <fmt/format.h>

#include "io/hdf5.hpp"
#include "io/increment_file.hpp"
#include "io/result_parts.hpp"

namespace voussoir::io {

namespace {

constexpr std::int64_t format_version = 1;

void write_bands(Hdf5File& file, const std::string& group, const Bands& bands, std::size_t members) {
  const std::string name = fmt::format("{}/{}/", group, bands.name);
  file.write(name + "mean", bands.mean, bands.shape, bands.unit);
  file.write(name + "deviation", bands.deviation, bands.shape, bands.unit);
  file.write(name + "mean_half_width", bands.mean_half_width, bands.shape, bands.unit);
  file.write(name + "prediction_half_width", bands.prediction_half_width, bands.shape, bands.unit);
  if (bands.members.empty()) return;
  std::vector<std::size_t> shape{members};
  shape.insert(shape.end(), bands.shape.begin(), bands.shape.end());
  file.write(name + "members", bands.members, shape, bands.unit);
}

void write_members(Hdf5File& file, const EnsembleData& data) {
  std::vector<std::string> names, ends;
  std::vector<std::int64_t> seeds, codes, reduced;
  for (const EnsembleMember& member : data.members) {
    names.push_back(member.name);
    ends.push_back(member.status);
    seeds.push_back(member.seed);
    codes.push_back(member.exit_code);
    reduced.push_back(member.reduced ? 1 : 0);
  }
  const std::vector<std::size_t> rows{data.members.size()};
  file.make_group("/members");
  file.write_texts("/members/name", names);
  file.write("/members/seed", seeds, rows, "-");
  file.write_texts("/members/status", ends);
  file.write("/members/exit_code", codes, rows, "-");
  file.write("/members/reduced", reduced, rows, "-");
  file.set_attribute("/members", "seeds_of_a_member", std::int64_t{data.seeds_of_a_member});
}

void write_rule(Hdf5File& file, const EnsembleData& data) {
  file.make_group("/bands");
  file.set_attribute("/bands", "members", std::int64_t{data.reduced});
  file.set_attribute("/bands", "confidence", data.confidence);
  file.set_attribute("/bands", "student_t", data.student_t);
  file.set_attribute("/bands", "mean_factor", data.mean_factor);
  file.set_attribute("/bands", "prediction_factor", data.prediction_factor);
  if (!data.goal) return;
  file.make_group("/until");
  file.set_attribute("/until", "result", data.goal->result);
  file.set_attribute("/until", "wanted", data.goal->wanted);
  file.set_attribute("/until", "reached", data.goal->reached);
}

void write_rows(Hdf5File& file, const EnsembleData& data) {
  std::vector<std::string> stages;
  std::vector<std::int64_t> index, stage_index, converged, good;
  std::vector<double> load;
  for (const EnsembleIncrement& row : data.increments) {
    stages.push_back(row.stage);
    index.push_back(row.index);
    stage_index.push_back(row.stage_index);
    load.push_back(row.load_parameter);
    converged.push_back(row.converged);
    good.push_back(row.good_troughs);
  }
  const std::vector<std::size_t> rows{data.increments.size()};
  file.make_group("/table");
  file.write("/table/index", index, rows, "-");
  file.write_texts("/table/stage", stages);
  file.write("/table/stage_index", stage_index, rows, "-");
  file.write("/table/load_parameter", load, rows, "-");
  file.write("/table/converged_members", converged, rows, "-");
  if (data.trough) file.write("/table/good_troughs", good, rows, "-");
}

}  // namespace

std::filesystem::path ensemble_fields_path(const std::filesystem::path& folder, int index) {
  return folder / "fields" / fmt::format("{:04}.h5", index);
}

void write_ensemble(const std::filesystem::path& folder, const EnsembleData& data) {
  Hdf5File file = Hdf5File::create(folder / "ensemble.h5");
  file.set_attribute("/", "format", std::string("voussoir ensemble"));
  file.set_attribute("/", "format_version", format_version);
  write_provenance(file, data.provenance);
  if (data.mesh.nodes() > 0) write_mesh(file, data.mesh);
  write_members(file, data);
  write_rule(file, data);
  write_rows(file, data);
  const auto members = static_cast<std::size_t>(data.reduced);
  file.make_group("/curves");
  for (const Bands& curve : data.curves) write_bands(file, "/curves", curve, members);
  file.make_group("/tables");
  for (const auto& [name, columns] : data.tables) {
    for (const Bands& column : columns) write_bands(file, "/tables/" + name, column, members);
  }
  if (data.trough) {
    file.write("/trough/x", data.trough_x, {data.trough_x.size()}, "m");
    write_bands(file, "/trough", *data.trough, members);
  }
  file.make_group("/fields");
  for (const EnsembleIncrement& row : data.increments) {
    const std::string name = ensemble_fields_path({}, row.index).filename().string();
    file.link_external(fmt::format("/fields/{:04}", row.index), "fields/" + name, "/");
  }
  file.publish();
}

void write_ensemble_fields(const std::filesystem::path& folder, const EnsembleIncrement& increment, int members,
                           const std::vector<std::pair<FieldLocation, Bands>>& fields) {
  Hdf5File file = Hdf5File::create(ensemble_fields_path(folder, increment.index));
  file.set_attribute("/", "format", std::string("voussoir ensemble fields"));
  file.set_attribute("/", "format_version", format_version);
  file.set_attribute("/", "members", std::int64_t{members});
  file.set_attribute("/", "index", std::int64_t{increment.index});
  file.set_attribute("/", "stage", increment.stage);
  file.set_attribute("/", "stage_index", std::int64_t{increment.stage_index});
  file.set_attribute("/", "load_parameter", increment.load_parameter);
  for (const auto& [location, bands] : fields) write_bands(file, fmt::format("/{}", group_of(location)), bands, 0);
  file.publish();
}

}  // namespace voussoir::io
