#include "io/sweep_file.hpp"

#include <fmt/format.h>

#include <limits>
#include <set>

#include "io/hdf5.hpp"

namespace voussoir::io {
namespace {

constexpr std::int64_t format_version = 1;

template <class Member>
std::vector<std::string> texts_of(const std::vector<SweepRow>& runs, Member member) {
  std::vector<std::string> texts;
  for (const SweepRow& run : runs) texts.push_back(run.*member);
  return texts;
}

template <class Value>
void write_column(Hdf5File& file, const std::string& name, const std::vector<SweepRow>& runs, const std::string& unit,
                  Value value) {
  std::vector<double> values;
  for (const SweepRow& run : runs) values.push_back(value(run));
  file.write(name, values, {runs.size()}, unit);
}

void write_runs(Hdf5File& file, const std::vector<SweepRow>& runs) {
  file.make_group("/runs");
  file.write_texts("/runs/name", texts_of(runs, &SweepRow::name));
  file.write_texts("/runs/status", texts_of(runs, &SweepRow::status));
  file.write_texts("/runs/reason", texts_of(runs, &SweepRow::reason));
  file.write_texts("/runs/kind", texts_of(runs, &SweepRow::kind));
  file.write_texts("/runs/grid", texts_of(runs, &SweepRow::grid));
  file.write_texts("/runs/point", texts_of(runs, &SweepRow::point));
  file.write_texts("/runs/stage", texts_of(runs, &SweepRow::stage));
  std::vector<std::int64_t> codes;
  for (const SweepRow& run : runs) codes.push_back(run.exit_code);
  file.write("/runs/exit_code", codes, {runs.size()}, "-");
  write_column(file, "/runs/load_parameter", runs, "-", [](const SweepRow& run) { return run.load_parameter; });
  write_column(file, "/runs/iterations", runs, "-", [](const SweepRow& run) { return run.iterations; });
  write_column(file, "/runs/particle_steps", runs, "-", [](const SweepRow& run) { return run.particle_steps; });
  write_column(file, "/runs/wall_s", runs, "s", [](const SweepRow& run) { return run.wall_time; });
}

/// A value as one field of a table: an array holds commas, and texts in it quotes.
std::string csv_field(const std::string& value) {
  if (value.find_first_of(",\"") == std::string::npos) return value;
  std::string quoted = "\"";
  for (const char letter : value) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  return quoted + "\"";
}

std::string unit_of(const std::vector<SweepRow>& runs, const std::string& result) {
  for (const SweepRow& run : runs) {
    if (const auto found = run.results.find(result); found != run.results.end()) return found->second.unit;
  }
  return "-";
}

}  // namespace

std::vector<std::string> axes_of(const std::vector<SweepRow>& runs) {
  std::set<std::string> names;
  for (const SweepRow& run : runs) {
    for (const auto& [name, value] : run.axes) names.insert(name);
  }
  return {names.begin(), names.end()};
}

std::vector<std::string> results_of(const std::vector<SweepRow>& runs) {
  std::set<std::string> names;
  for (const SweepRow& run : runs) {
    for (const auto& [name, value] : run.results) names.insert(name);
  }
  return {names.begin(), names.end()};
}

void write_sweep(const std::filesystem::path& file, const SweepData& data) {
  Hdf5File out = Hdf5File::create(file);
  out.set_attribute("/", "format", std::string("voussoir sweep"));
  out.set_attribute("/", "format_version", format_version);
  out.write_text("/input", data.input);
  write_runs(out, data.runs);
  out.make_group("/axes");
  for (const std::string& axis : axes_of(data.runs)) {
    std::vector<std::string> values;
    for (const SweepRow& run : data.runs) values.push_back(run.axes.contains(axis) ? run.axes.at(axis) : "");
    out.write_texts("/axes/" + axis, values);
  }
  out.make_group("/results");
  for (const std::string& result : results_of(data.runs)) {
    write_column(out, "/results/" + result, data.runs, unit_of(data.runs, result), [&result](const SweepRow& run) {
      const auto found = run.results.find(result);
      return found == run.results.end() ? std::numeric_limits<double>::quiet_NaN() : found->second.value;
    });
  }
  out.make_group("/ensembles");
  if (!data.ensembles.empty()) out.write_texts("/ensembles/name", data.ensembles);
  out.publish();
}

std::string summary_csv(const std::vector<SweepRow>& runs) {
  const std::vector<std::string> axes = axes_of(runs), results = results_of(runs);
  std::string text = "name,status,exit_code";
  for (const std::string& axis : axes) text += "," + axis;
  text += ",stage,load_parameter,iterations,particle_steps,wall_s";
  for (const std::string& result : results) text += "," + result;
  text += "\n";
  for (const SweepRow& run : runs) {
    text += fmt::format("{},{},{}", run.name, run.status, run.exit_code);
    for (const std::string& axis : axes) text += "," + (run.axes.contains(axis) ? csv_field(run.axes.at(axis)) : "");
    text += fmt::format(",{},{:.9g},{:.0f},{:.9g},{:.2f}", run.stage, run.load_parameter, run.iterations,
                        run.particle_steps, run.wall_time);
    for (const std::string& result : results) {
      const auto found = run.results.find(result);
      text += found == run.results.end() ? "," : fmt::format(",{:.9g}", found->second.value);
    }
    text += "\n";
  }
  return text;
}

}  // namespace voussoir::io
