#include "host/library/voussoir.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <span>
#include <sstream>

#include "host/case/load_case.hpp"
#include "host/library/accepted_case.hpp"
#include "host/library/c_calls.hpp"
#include "host/process/build_info.hpp"
#include "host/process/exit_code.hpp"

namespace voussoir::library {
namespace {

using kernels::RveStatus;
static_assert(voussoir_converged == static_cast<int>(RveStatus::converged) &&
              voussoir_step_limit == static_cast<int>(RveStatus::step_limit) &&
              voussoir_open == static_cast<int>(RveStatus::open) &&
              voussoir_neighbour_overflow == static_cast<int>(RveStatus::neighbour_overflow) &&
              voussoir_overlap_limit == static_cast<int>(RveStatus::overlap_limit) &&
              voussoir_not_finite == static_cast<int>(RveStatus::not_finite));
static_assert(voussoir_ok == host::exit_code(host::Outcome::done) &&
              voussoir_wrong_input == host::exit_code(host::Outcome::wrong_input) &&
              voussoir_no_equilibrium == host::exit_code(host::Outcome::no_equilibrium) &&
              voussoir_machine_failure == host::exit_code(host::Outcome::machine_failure) &&
              voussoir_interrupted == host::exit_code(host::Outcome::interrupted));

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class T>
void require(const T* pointer, const char* name) {
  if (pointer == nullptr) throw Misuse(std::string(name) + " is NULL");
}

void require_equal(std::int64_t given, std::size_t right, const char* name) {
  if (given == static_cast<std::int64_t>(right)) return;
  throw Misuse(std::string(name) + " is " + std::to_string(given) + ", and " + std::to_string(right) + " is right");
}

std::vector<std::string> lines_of(const char* text) {
  std::vector<std::string> lines;
  std::istringstream stream(text == nullptr ? "" : text);
  for (std::string line; std::getline(stream, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

/// The arrays of a caller, in which its RVEs write their answers. @param tangent may be NULL
AnswerArrays answers_in(CRves& rves, double* stress, double* tangent) {
  const std::size_t n = rves.batch->size();
  rves.points.resize(n);
  return {{stress, 3 * n}, {tangent, tangent == nullptr ? 0 : 9 * n}, rves.points};
}

/// @param gradients (n, 2, 2)
void refuse_inside_out(std::span<const double> gradients) {
  for (std::size_t k = 0; k < gradients.size() / 4; ++k) {
    const double* h = &gradients[4 * k];
    if ((1 + h[0]) * (1 + h[3]) - h[1] * h[2] <= 0) {
      throw std::invalid_argument("the gradient of RVE " + std::to_string(k) +
                                  " turns the cell inside out (det F <= 0)");
    }
  }
}

VoussoirReport report_of(const fem::BatchReport& from, std::int64_t failed) {
  const auto number = [](std::size_t n) { return static_cast<std::int64_t>(n); };
  VoussoirReport out{};
  out.stress_noise = from.stress_noise;
  out.unsettled_stress = from.unsettled_stress;
  out.mean_overlap = from.mean_overlap.value_or(0);
  out.deferral_error = from.deferral_error;
  out.work = number(from.work);
  out.failed = failed;
  out.step_limit = number(from.step_limit);
  out.open = number(from.open);
  out.out_of_range = number(from.out_of_range);
  out.deferred = number(from.deferred);
  return out;
}

/// The arrays of voussoir_evaluate.
struct CallerArrays {
  const double* gradients;
  double* stress;
  double* tangent;  ///< may be NULL, as the next one
  std::int32_t* status;
};

int evaluate(CRves& rves, const CallerArrays& of) {
  require(of.gradients, "gradients");
  require(of.stress, "stress");
  const std::span<const double> gradients{of.gradients, 4 * rves.batch->size()};
  require_finite(gradients);
  refuse_inside_out(gradients);
  const fem::BatchReport report = rves.batch->evaluate(gradients, answers_in(rves, of.stress, of.tangent));
  rves.report = report_of(report, std::count_if(rves.points.begin(), rves.points.end(), [](const PointReport& point) {
                            return kernels::is_failure(static_cast<RveStatus>(point.status));
                          }));
  if (report.usable) return voussoir_ok;
  remember(report.message);
  return voussoir_no_equilibrium;
}

/// All answers are NaN and all statuses -1 where an exception leaves this function.
int evaluate_or_clear(CRves& rves, const CallerArrays& arrays) {
  const std::size_t n = rves.batch->size();
  const auto clear = [&] {
    if (arrays.stress != nullptr) std::fill_n(arrays.stress, 3 * n, nan);
    if (arrays.tangent != nullptr) std::fill_n(arrays.tangent, 9 * n, nan);
    if (arrays.status != nullptr) std::fill_n(arrays.status, n, -1);
  };
  try {
    const int code = evaluate(rves, arrays);
    for (std::size_t k = 0; arrays.status != nullptr && k < n; ++k) arrays.status[k] = rves.points[k].status;
    return code;
  } catch (const std::invalid_argument& fault) {
    clear();
    throw Misuse(fault.what());
  } catch (...) {
    clear();
    throw;
  }
}

const std::vector<fem::PointField>& fields_of(CRves& rves) {
  if (rves.fields.empty()) rves.fields = rves.batch->fields();
  return rves.fields;
}

/// A text that lives as long as the process. There are as many of them as there are fields.
const char* kept(const std::string& text) {
  static auto* const texts = new std::set<std::string>;
  return texts->insert(text).first->c_str();
}

}  // namespace
}  // namespace voussoir::library

using namespace voussoir;  // NOLINT(google-build-using-namespace): the functions below stand outside of every namespace
using library::Misuse;

const char* voussoir_version(void) { return host::build_version; }

const char* voussoir_last_error(void) { return library::last_error(); }

const char* voussoir_status_name(int32_t status) {
  if (status < voussoir_converged || status > voussoir_not_finite) return "";
  return kernels::name_of(static_cast<kernels::RveStatus>(status));
}

int voussoir_start(int32_t threads) {
  return library::guarded(__func__, [&] { library::start_threads(threads); });
}

int voussoir_stop(void) {
  return library::guarded(__func__, [] { library::stop_threads(); });
}

int32_t voussoir_threads(void) {
  std::int32_t threads = 0;
  library::guarded(__func__, [&] { threads = library::running_threads(); });
  return threads;
}

int voussoir_create(const char* case_file, int64_t n, const char* settings, VoussoirNote note, void* context,
                    VoussoirRves** rves) {
  if (rves != nullptr) *rves = nullptr;
  return library::guarded(__func__, [&] {
    library::require(rves, "rves");
    library::require(case_file, "case_file");
    if (n < 1) throw Misuse("n is " + std::to_string(n) + ", and at least 1 is right");
    library::require_threads();
    library::Note lines;
    if (note != nullptr) lines = [&](const std::string& line) { note(line.c_str(), context); };
    const auto size = static_cast<std::size_t>(n);
    const host::Case input = library::accepted(host::load_case(case_file, library::lines_of(settings)));
    auto ours = std::make_unique<library::CRves>();
    ours->batch = library::make_batch(input, library::mix_of(input, size, lines));
    if (const std::string device = ours->batch->device_sentence(); lines && !device.empty()) lines(device);
    *rves = library::new_handle(std::move(ours));
  });
}

int voussoir_destroy(VoussoirRves* rves) {
  return library::guarded(__func__, [&] {
    if (rves != nullptr) library::free_rves(rves);
  });
}

int64_t voussoir_size(const VoussoirRves* rves) {
  std::int64_t size = 0;
  library::guarded(__func__, [&] {
    if (const library::CRves* ours = library::find_rves(rves)) size = static_cast<std::int64_t>(ours->batch->size());
  });
  return size;
}

int voussoir_begin_increment(VoussoirRves* rves) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    ours.batch->forget_trial();
    ours.batch->begin_increment();
  });
}

int voussoir_evaluate(VoussoirRves* rves, int64_t n, const double* gradients, double* stress, double* tangent,
                      int32_t* status) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    ours.batch->forget_trial();
    ours.report.reset();
    library::require_equal(n, ours.batch->size(), "n");
    return library::evaluate_or_clear(ours, {gradients, stress, tangent, status});
  });
}

int voussoir_commit(VoussoirRves* rves) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    if (!ours.batch->may_commit())
      throw Misuse("there is no evaluation since the last commit of which all RVEs have answers");
    ours.fields.clear();
    ours.batch->commit();
  });
}

int voussoir_committed(VoussoirRves* rves, int64_t n, double* stress, double* tangent) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    library::require_equal(n, ours.batch->size(), "n");
    library::require(stress, "stress");
    ours.batch->committed(library::answers_in(ours, stress, tangent));
  });
}

int voussoir_report(VoussoirRves* rves, VoussoirReport* report) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    library::require(report, "report");
    if (!ours.report) throw Misuse("there is no evaluation yet, or the last one was refused");
    *report = *ours.report;
  });
}

int voussoir_state_size(VoussoirRves* rves, int64_t* size) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    library::require(size, "size");
    *size = static_cast<std::int64_t>(ours.batch->hold()->size());
  });
}

int voussoir_get_state(VoussoirRves* rves, void* bytes, int64_t size) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    library::require(bytes, "bytes");
    const auto held = ours.batch->hold();
    library::require_equal(size, held->size(), "size");
    auto* to = static_cast<std::byte*>(bytes);
    held->write([&](std::span<const std::byte> piece) { to = std::copy(piece.begin(), piece.end(), to); });
  });
}

int voussoir_set_state(VoussoirRves* rves, const void* bytes, int64_t size) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    library::require(bytes, "bytes");
    if (size < 0) throw Misuse("size is negative");
    try {
      std::vector<std::size_t> all(ours.batch->size());
      std::iota(all.begin(), all.end(), std::size_t{0});
      ours.batch->set_state({static_cast<const std::byte*>(bytes), static_cast<std::size_t>(size)}, all);
      ours.fields.clear();
    } catch (const std::runtime_error& fault) {
      library::remember(std::string("the state cannot be set: ") + fault.what());
      return static_cast<int>(voussoir_wrong_input);
    }
    return static_cast<int>(voussoir_ok);
  });
}

int voussoir_field_count(VoussoirRves* rves, int64_t* count) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    library::require(count, "count");
    *count = static_cast<std::int64_t>(library::fields_of(ours).size());
  });
}

int voussoir_field(VoussoirRves* rves, int64_t index, const char** name, const char** unit, int32_t* components) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    const auto& fields = library::fields_of(ours);
    if (index < 0 || index >= static_cast<std::int64_t>(fields.size())) {
      throw Misuse("there is no field " + std::to_string(index) + " of " + std::to_string(fields.size()));
    }
    const fem::PointField& field = fields[static_cast<std::size_t>(index)];
    if (name != nullptr) *name = library::kept(field.name);
    if (unit != nullptr) *unit = library::kept(field.unit);
    if (components != nullptr) *components = field.components;
  });
}

int voussoir_field_values(VoussoirRves* rves, const char* name, double* values, int64_t size) {
  return library::guarded(__func__, rves, [&](library::CRves& ours) {
    library::require(name, "name");
    library::require(values, "values");
    for (const fem::PointField& field : library::fields_of(ours)) {
      if (field.name != name) continue;
      library::require_equal(size, field.values.size(), "size");
      std::copy(field.values.begin(), field.values.end(), values);
      return;
    }
    throw Misuse("there is no field " + std::string(name));
  });
}
