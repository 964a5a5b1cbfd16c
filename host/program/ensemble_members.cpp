#include "host/program/ensemble_members.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "host/ensemble/csv.hpp"
#include "host/ensemble/draws.hpp"
#include "host/ensemble/reduction.hpp"
#include "host/packing/packings.hpp"
#include "host/process/interrupt.hpp"
#include "host/record/provenance.hpp"
#include "io/atomic_file.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

/// True where a run has results up to the planned end. A run that ends without equilibrium may have gone on beyond
/// increments that did not converge: leaving it out would choose the members by their answers.
bool has_all_increments(const ProcessRun& run, const Case& input, const MemberResults& results) {
  if (run.end.outcome == Outcome::done) return true;
  return run.end.outcome == Outcome::no_equilibrium && is_at_end(input, results.increments);
}

std::vector<io::EnsembleMember> members_of(const EnsembleMembers& ensemble) {
  std::vector<io::EnsembleMember> members;
  for (std::size_t k = 0; k < ensemble.runs.size(); ++k) {
    const ProcessRun& run = ensemble.runs[k];
    members.push_back(
        {run.name, seed_of(ensemble.input, ensemble.numbers[k]), name_of(run.end), run.end.code, ensemble.reduced[k]});
  }
  return members;
}

/// One line on standard error, which names the point where there are several ensembles.
void complain(const EnsembleMembers& ensemble, const std::string& sentence) {
  std::fprintf(stderr, "voussoir: %s%s%s\n", ensemble.point.c_str(), ensemble.point.empty() ? "" : ": ",
               sentence.c_str());
}

/// Names the members that did not end well: those with results up to the end, and those without.
void name_failed(const EnsembleMembers& ensemble, bool reduced) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < ensemble.runs.size(); ++k) {
    const ProcessRun& run = ensemble.runs[k];
    if (run.end.outcome == Outcome::done || ensemble.reduced[k] != reduced) continue;
    names.push_back(fmt::format("{} ({})", run.name, name_of(run.end)));
  }
  if (names.empty()) return;
  const bool one = names.size() == 1;
  const std::string what = reduced ? fmt::format("{} increments that did not converge and {} part of",
                                                 one ? "has" : "have", one ? "is" : "are")
                                   : fmt::format("{} no results up to the end and {} no part of", one ? "has" : "have",
                                                 one ? "is" : "are");
  complain(ensemble, fmt::format("{} of {} members {} the means and bands: {}", names.size(), ensemble.runs.size(),
                                 what, fmt::join(names, ", ")));
}

/// A member that is done and has no results is not left out in silence. Throws std::runtime_error.
void expect_results(const EnsembleMembers& ensemble) {
  for (std::size_t k = 0; k < ensemble.runs.size(); ++k) {
    const ProcessRun& run = ensemble.runs[k];
    if (run.end.outcome == Outcome::done && !ensemble.reduced[k])
      throw std::runtime_error(fmt::format("{}: the run is done, but its results are missing", run.folder.string()));
  }
}

/// Says whether the folder still belongs to this process, as a run does before each write.
void confirm(const RunLock& lock) {
  const std::string changed = lock.confirm();
  if (!changed.empty()) std::fprintf(stderr, "voussoir: %s\n", changed.c_str());
}

/// A reduction that is killed leaves no ensemble.h5, rather than one whose fields are of other members.
void remove_earlier_reduction(const fs::path& folder) {
  for (const char* name : {"ensemble.h5", "curves.csv", "members.csv"}) fs::remove(folder / name);
  fs::remove_all(folder / "fields");
}

io::Provenance provenance_of(const EnsembleMembers& ensemble) {
  RunOptions options{.folder = ensemble.folder, .command = ensemble.command};
  options.threads = io::read_provenance(ensemble.finished.front().folder / "run.h5").threads;
  return provenance_of(options, ensemble.input, to_string(ensemble.input.kind));
}

/// Writes the means and bands. Returns false where a request to stop ended the reduction.
bool reduce(const EnsembleMembers& ensemble, std::optional<double> error, const RunLock& lock) {
  const fs::path& folder = ensemble.folder;
  const BandRule rule = band_rule(static_cast<int>(ensemble.finished.size()));
  io::EnsembleData data;
  data.provenance = provenance_of(ensemble);
  data.members = members_of(ensemble);
  data.seeds_of_a_member = static_cast<int>(count_of_packings(ensemble.input.packing));
  if (ensemble.goal) data.goal = {ensemble.goal->result, ensemble.goal->share, error.value_or(0)};
  reduce_curves(ensemble.finished, rule, data);
  const auto most = std::max_element(
      ensemble.finished.begin(), ensemble.finished.end(),
      [](const MemberResults& a, const MemberResults& b) { return a.increments.size() < b.increments.size(); });
  if (most->increments.size() > data.increments.size()) {
    complain(ensemble, fmt::format("{} increments of {} are left out, because another member lacks them",
                                   most->increments.size() - data.increments.size(), most->folder.string()));
  }
  fs::create_directories(folder / "fields");
  const bool whole = reduce_fields(ensemble.finished, rule, data.increments, folder, [&lock] {
    confirm(lock);
    return !interrupted();
  });
  if (!whole) return false;
  io::write_text(folder / "curves.csv", curves_csv(data));
  io::write_text(folder / "members.csv", members_csv(data.members, ensemble.finished));
  io::write_ensemble(folder, data);
  std::printf("means and bands of %d members: %s\n", rule.members, (folder / "ensemble.h5").c_str());
  return true;
}

}  // namespace

ProcessRun member_run(const EnsembleMembers& ensemble, const fs::path& case_file,
                      const std::vector<std::string>& overrides, std::size_t member) {
  ProcessRun run{.name = member_name(member), .case_file = case_file, .overrides = overrides, .folder = {}};
  run.overrides.push_back(seed_override(ensemble.input, member));
  run.folder = ensemble.folder / run.name;
  return run;
}

void add_member(EnsembleMembers& ensemble, ProcessRun run, std::size_t member, ReadRun read) {
  const bool counts = read.results && has_all_increments(run, ensemble.input, *read.results);
  if (counts) ensemble.finished.push_back(*std::move(read.results));
  ensemble.reduced.push_back(counts);
  ensemble.rows.push_back(std::move(read.row));
  ensemble.runs.push_back(std::move(run));
  ensemble.numbers.push_back(member);
}

void write_summary(const EnsembleMembers& ensemble) {
  io::write_text(ensemble.folder / "summary.csv", io::summary_csv(ensemble.rows));
}

Outcome reduce_members(const EnsembleMembers& ensemble, std::optional<double> error, const RunLock& lock) {
  confirm(lock);
  std::vector<RunEnd> ends;
  for (const ProcessRun& run : ensemble.runs) ends.push_back(run.end);
  const Outcome outcome = outcome_of(ends);
  if (interrupted() || outcome == Outcome::interrupted) return Outcome::interrupted;
  expect_results(ensemble);
  name_failed(ensemble, true);
  name_failed(ensemble, false);
  remove_earlier_reduction(ensemble.folder);
  if (ensemble.finished.size() < 2) {
    io::write_text(ensemble.folder / "members.csv", members_csv(members_of(ensemble), ensemble.finished));
    complain(ensemble, fmt::format("means and bands need two members with results up to the end, and there {}",
                                   ensemble.finished.empty() ? "is none" : "is one"));
    return outcome;
  }
  return reduce(ensemble, error, lock) ? outcome : Outcome::interrupted;
}

}  // namespace voussoir::host
