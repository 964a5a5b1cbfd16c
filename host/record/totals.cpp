#include "host/record/totals.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <limits>

#include "host/packing/law_range.hpp"

namespace voussoir::host {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

StageTotals sum_of(const std::vector<StageTotals>& totals) {
  StageTotals sum;
  sum.stage = "all";
  for (const StageTotals& stage : totals) {
    sum.evaluations.insert(sum.evaluations.end(), stage.evaluations.begin(), stage.evaluations.end());
    sum.cuts += stage.cuts;
    sum.particle_steps += stage.particle_steps;
    sum.lane_steps += stage.lane_steps;
    sum.parts += stage.parts;
    sum.output += stage.output;
    sum.writer += stage.writer;
    sum.wall += stage.wall;
  }
  return sum;
}

std::string row(const StageTotals& t) {
  const double named = t.parts.material + t.parts.tangents + t.parts.assembly + t.parts.solve + t.output;
  const double most = t.evaluations.empty() ? 0 : *std::max_element(t.evaluations.begin(), t.evaluations.end());
  return fmt::format(
      "{:<12}{:>6}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>9.1f}{:>9.1f}{:>9.1f}{:>9.1f}{:>8.3g}{:>7.3g}{:>6}{:>13.3e}{:>"
      "9.1f}",
      t.stage, t.evaluations.size(), t.wall, t.parts.material, t.parts.tangents, t.parts.assembly, t.parts.solve,
      t.output, t.writer.wall, t.wall - named, median(t.evaluations), most, t.cuts, t.particle_steps,
      t.parts.material > 0 ? 1e-6 * t.particle_steps / t.parts.material : 0.0);
}

}  // namespace

WriterTime WriterTime::now() {
  timespec processor{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &processor);
  return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          static_cast<double>(processor.tv_sec) + 1e-9 * static_cast<double>(processor.tv_nsec)};
}

void save(const std::vector<StageTotals>& totals, io::Checkpoint& checkpoint) {
  std::string names;
  for (std::size_t k = 0; k < totals.size(); ++k) {
    const StageTotals& t = totals[k];
    names += t.stage + "\n";
    const std::vector<double> numbers{static_cast<double>(t.cuts),
                                      t.particle_steps,
                                      t.parts.material,
                                      t.parts.assembly,
                                      t.parts.solve,
                                      t.output,
                                      t.wall,
                                      t.writer.wall,
                                      t.writer.processor};
    checkpoint.put_doubles(fmt::format("totals_{}", k), numbers);
    checkpoint.put_doubles(fmt::format("totals_lane_steps_{}", k), {&t.lane_steps, 1});
    checkpoint.put_doubles(fmt::format("totals_tangents_{}", k), {&t.parts.tangents, 1});
    checkpoint.put_doubles(fmt::format("totals_evaluations_{}", k), t.evaluations);
    checkpoint.put_doubles(fmt::format("totals_unsettled_{}", k), t.step_limit_points);
    checkpoint.put_doubles(fmt::format("totals_unsettled_share_{}", k), t.unsettled);
    checkpoint.put_doubles(fmt::format("totals_out_of_range_{}", k), t.out_of_range_points);
    checkpoint.put_doubles(fmt::format("totals_mean_overlap_{}", k), t.mean_overlap);
    if (!t.deferral_error.empty()) checkpoint.put_doubles(fmt::format("totals_deferral_{}", k), t.deferral_error);
  }
  checkpoint.put_text("totals", names);
}

std::vector<StageTotals> totals_from(const io::Checkpoint& checkpoint) {
  std::vector<StageTotals> totals;
  if (!checkpoint.has("totals")) return totals;
  const std::string names = checkpoint.get_text("totals");
  for (std::size_t begin = 0, end = 0; (end = names.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::vector<double> numbers = checkpoint.get_doubles(fmt::format("totals_{}", totals.size()));
    StageTotals t;
    t.stage = names.substr(begin, end - begin);
    t.evaluations = checkpoint.get_doubles(fmt::format("totals_evaluations_{}", totals.size()));
    t.step_limit_points = checkpoint.get_doubles(fmt::format("totals_unsettled_{}", totals.size()));
    t.unsettled = checkpoint.get_doubles(fmt::format("totals_unsettled_share_{}", totals.size()));
    const std::string range = fmt::format("totals_out_of_range_{}", totals.size());
    if (checkpoint.has(range)) t.out_of_range_points = checkpoint.get_doubles(range);
    const std::string overlap = fmt::format("totals_mean_overlap_{}", totals.size());
    if (checkpoint.has(overlap)) t.mean_overlap = checkpoint.get_doubles(overlap);
    const std::string deferral = fmt::format("totals_deferral_{}", totals.size());
    if (checkpoint.has(deferral)) t.deferral_error = checkpoint.get_doubles(deferral);
    const std::string lanes = fmt::format("totals_lane_steps_{}", totals.size());
    t.lane_steps = checkpoint.has(lanes) ? checkpoint.get_doubles(lanes).at(0)
                                         : std::numeric_limits<double>::quiet_NaN();
    t.cuts = static_cast<int>(numbers.at(0));
    t.particle_steps = numbers.at(1);
    t.parts = {.material = numbers.at(2), .assembly = numbers.at(3), .solve = numbers.at(4)};
    const std::string tangents = fmt::format("totals_tangents_{}", totals.size());
    if (checkpoint.has(tangents)) t.parts.tangents = checkpoint.get_doubles(tangents).at(0);
    t.output = numbers.at(5);
    t.wall = numbers.at(6);
    if (numbers.size() > 8) t.writer = {numbers[7], numbers[8]};  // earlier versions had no writer
    totals.push_back(t);
  }
  return totals;
}

std::string unsettled_line(const StageTotals& stage, std::size_t points) {
  const auto increments = std::count_if(stage.step_limit_points.begin(), stage.step_limit_points.end(),
                                        [](double n) { return n > 0; });
  if (increments == 0) return {};
  return fmt::format(
      "{}: {} of {} increments ended with RVEs at the step limit, up to {} of {}: their grains are not at rest. If "
      "their stresses were off by as much as their pressure, the residual would be off by {:.2g} of its tolerance at "
      "the "
      "most",
      stage.stage, increments, stage.step_limit_points.size(),
      *std::max_element(stage.step_limit_points.begin(), stage.step_limit_points.end()), points,
      *std::max_element(stage.unsettled.begin(), stage.unsettled.end()));
}

std::string range_line(const StageTotals& stage, std::size_t points) {
  const auto& beyond = stage.out_of_range_points;
  const auto increments = std::count_if(beyond.begin(), beyond.end(), [](double n) { return n > 0; });
  if (increments == 0) return {};
  return fmt::format(
      "{}: in {} of {} increments RVEs were pressed beyond what the contact law is good for, up to {} of {}: their "
      "mean "
      "overlap passed {:.0f} % of r_i + r_j (the largest was {:.1f} %), or their void ratio fell below that of the "
      "densest packing (docs/explanation/range.md)",
      stage.stage, increments, beyond.size(), *std::max_element(beyond.begin(), beyond.end()), points,
      100 * most_mean_overlap, 100 * *std::max_element(stage.mean_overlap.begin(), stage.mean_overlap.end()));
}

std::string deferral_line(const StageTotals& stage, double bound) {
  if (stage.deferral_error.empty()) return {};
  const double largest = *std::max_element(stage.deferral_error.begin(), stage.deferral_error.end());
  const auto beyond = std::count_if(stage.deferral_error.begin(), stage.deferral_error.end(),
                                    [=](double e) { return e > bound; });
  return fmt::format(
      "{}: RVEs that answered by their tangent were off by up to {:.1e} of their pressure, as far as their grains have "
      "moved since; in {} of {} increments an RVE was off by more than engine.defer = {:g}",
      stage.stage, largest, beyond, stage.deferral_error.size(), bound);
}

std::string lanes_line(const StageTotals& stage) {
  if (!(stage.lane_steps > 0)) return {};
  return fmt::format(
      "{}: {:.1f} % of the steps of the lanes moved a grain; in the others a lane had no RVE, or waited for "
      "the slowest RVE of its group",
      stage.stage, 100 * stage.particle_steps / stage.lane_steps);
}

std::vector<std::string> totals_table(const std::vector<StageTotals>& totals) {
  std::vector<std::string> lines;
  if (totals.empty()) return lines;
  lines.emplace_back(
      "the columns are: wall time [s] by stage and part, output being the time that the run waited for its files, and "
      "writer the time of the thread that writes them meanwhile; evaluations of an increment (median, largest); "
      "particle-steps, "
      "and how many 10^6 of them the grains made in a second");
  lines.push_back(fmt::format("{:<12}{:>6}{:>10}{:>10}{:>10}{:>10}{:>9}{:>9}{:>9}{:>9}{:>8}{:>7}{:>6}{:>13}{:>9}",
                              "stage", "incr.", "wall", "grains", "tangents", "assembly", "solve", "output", "writer",
                              "other", "eval.", "most", "cuts", "steps", "M/s"));
  for (const StageTotals& stage : totals) lines.push_back(row(stage));
  if (totals.size() > 1) lines.push_back(row(sum_of(totals)));
  return lines;
}

}  // namespace voussoir::host
