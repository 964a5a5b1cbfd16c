#pragma once
/// Launches, checks and times of the lists and of the steps: one line of the table each.

#include <cstdio>
#include <cstring>
#include <memory>

#include "tests/benchmark/gpu_step/cuda_team.hpp"
#include "tests/benchmark/gpu_step/device.hpp"
#include "tests/benchmark/gpu_step/packing_file.hpp"

namespace voussoir::gpu_step {

template <class Real, int threads, int lanes, int blocks>
__global__ void __launch_bounds__(threads, blocks) list_kernel(const __grid_constant__ ListArguments<Real> a) {
  using Team = CudaTeam<threads>;
  const Team team;
  ListThread<Real, lanes, Team>(team, a).run();
}

template <class Choice>
__global__ void __launch_bounds__(Choice::threads, Choice::blocks)
    step_kernel(const __grid_constant__ StepArguments<typename Choice::Real> a) {
  using Team = CudaTeam<Choice::threads>;
  const Team team;
  StepThread<Choice, Team>(team, a).run();
}

/// What all lines of a table have in common.
struct Run {
  std::string only;     ///< a part of the names to be measured; empty: all
  int steps = 400;      ///< of a launch
  int look_every = 16;  ///< of the instances that look
  int repeats = 5;
  bool times = true;  ///< false: one launch of each, for profilers and sanitizers
};

/// Copies of a packing on the card, each moved and with a list of its own.
template <class Real>
class Batch {
 public:
  Batch(const Rve& packing, int rves)
      : rves_(rves),
        grains_(packing.grains()),
        packing_(packing),
        capacity_((static_cast<int>(near_pairs(packing).size()) + 63) / 32 * 32),  // moved, a pair or two may be more
        n_pairs_(static_cast<std::size_t>(rves) * static_cast<std::size_t>(capacity_)),
        n_rows_(static_cast<std::size_t>(rves) * static_cast<std::size_t>(grains_ + 1)),
        radius_(packing.radius),
        real_radius_(std::vector<Real>(packing.radius.begin(), packing.radius.end())),
        cell_(std::vector<Mat2>(static_cast<std::size_t>(rves), packing.cell)),
        kept_count_(std::vector<int>(static_cast<std::size_t>(rves), static_cast<int>(packing.kept.size()))) {
    std::vector<double> position;
    std::vector<std::uint32_t> kept;
    std::vector<Two<double>> history;
    std::vector<Mat2> growth;
    for (int v = 0; v < rves; ++v) {
      const Rve rve = moved(packing, v);
      position.insert(position.end(), rve.position.begin(), rve.position.end());
      kept.insert(kept.end(), rve.kept.begin(), rve.kept.end());
      history.insert(history.end(), rve.history.begin(), rve.history.end());
      growth.push_back(growth_of(v));
    }
    position_.upload(position);
    kept_.upload(kept);
    history_.upload(history);
    growth_.upload(growth);
  }

  [[nodiscard]] int rves() const { return rves_; }
  [[nodiscard]] int grains() const { return grains_; }
  [[nodiscard]] int capacity() const { return capacity_; }
  [[nodiscard]] ListStore<Real> reference(int rve) const {
    return reference_list<Real>(moved(packing_, rve), capacity_);
  }
  [[nodiscard]] const std::vector<double>& radii() const { return packing_.radius; }

  [[nodiscard]] ListArguments<Real> list_arguments() const {
    return {grains_,         packing_.skin,      position_.data(),
            cell_.data(),    radius_.data(),     kept_.data(),
            history_.data(), kept_count_.data(), static_cast<int>(packing_.kept.size()),
            lists()};
  }
  [[nodiscard]] StepArguments<Real> step_arguments(int steps, int look_every) const {
    return {lists(),
            real_radius_.data(),
            growth_.data(),
            state_.data(),
            spin_.data(),
            report_.data(),
            grains_,
            steps,
            look_every,
            0.0,
            literal_sand<Real>()};
  }

  [[nodiscard]] ListStore<Real> download_lists() const {
    ListStore<Real> s(rves_, grains_, capacity_);
    branch_x_.download(s.branch_x), branch_y_.download(s.branch_y), gap_.download(s.gap);
    tangential_.download(s.tangential), moment_.download(s.moment), keys_.download(s.grains);
    row_.download(s.row), incoming_row_.download(s.incoming_row), incoming_.download(s.incoming);
    pair_count_.download(s.pair_count);
    return s;
  }
  [[nodiscard]] int most_pairs() const {
    std::vector<int> count(static_cast<std::size_t>(rves_));
    pair_count_.download(count);
    return *std::max_element(count.begin(), count.end());
  }
  [[nodiscard]] StepState<Real> download_state(int rve) const {
    const auto n = static_cast<std::size_t>(grains_), first = n * static_cast<std::size_t>(rve);
    StepState<Real> s{std::vector<Quad<Real>>(n), std::vector<Two<Real>>(n)};
    state_.download(s.state, first), spin_.download(s.spin, first);
    std::vector<LookReport> report(1);
    report_.download(report, static_cast<std::size_t>(rve));
    s.report = report[0];
    return s;
  }

 private:
  [[nodiscard]] PairLists<Real> lists() const {
    return {capacity_,    branch_x_.data(), branch_y_.data(),     gap_.data(),      tangential_.data(), moment_.data(),
            keys_.data(), row_.data(),      incoming_row_.data(), incoming_.data(), pair_count_.data()};
  }
  [[nodiscard]] std::size_t all_grains() const {
    return static_cast<std::size_t>(rves_) * static_cast<std::size_t>(grains_);
  }

  int rves_, grains_;
  Rve packing_;
  int capacity_;
  std::size_t n_pairs_, n_rows_;
  DeviceArray<double> radius_;
  DeviceArray<Real> real_radius_;
  DeviceArray<Mat2> cell_;
  DeviceArray<int> kept_count_;
  DeviceArray<double> position_{2 * all_grains()};
  DeviceArray<std::uint32_t> kept_{static_cast<std::size_t>(rves_) * packing_.kept.size()};
  DeviceArray<Two<double>> history_{static_cast<std::size_t>(rves_) * packing_.kept.size()};
  DeviceArray<Mat2> growth_{static_cast<std::size_t>(rves_)};
  DeviceArray<Real> branch_x_{n_pairs_}, branch_y_{n_pairs_}, gap_{n_pairs_}, tangential_{n_pairs_}, moment_{n_pairs_};
  DeviceArray<std::uint32_t> keys_{n_pairs_};
  DeviceArray<std::uint16_t> row_{n_rows_}, incoming_row_{n_rows_}, incoming_{n_pairs_};
  DeviceArray<int> pair_count_{static_cast<std::size_t>(rves_)};
  DeviceArray<Quad<Real>> state_{all_grains()};
  DeviceArray<Two<Real>> spin_{all_grains()};
  DeviceArray<LookReport> report_{static_cast<std::size_t>(rves_)};
};

/// RVEs that are compared with the host: the first, one in the middle and the last.
inline std::vector<int> compared(int rves) { return {0, rves / 2, rves - 1}; }

template <class Real>
void print_head(const char* name, const Batch<Real>& batch, int threads, const KernelUse& use, std::size_t shared) {
  std::printf("%-34s %-6s N %4d RVEs %5d | registers %3d stack %3zu warps/SM %2d shared %6zu | ", name,
              sizeof(Real) == 4 ? "float" : "double", batch.grains(), batch.rves(), use.registers, use.stack,
              use.blocks * threads / 32, shared);
}

/// Makes the lists of all RVEs, compares them, prints how long that takes.
template <class Real, int threads, int lanes, int blocks>
void list_line(const char* name, const Batch<Real>& batch, const Run& run) {
  if (std::strstr(name, run.only.c_str()) == nullptr) return;
  const auto kernel = list_kernel<Real, threads, lanes, blocks>;
  const std::size_t bytes = list_bytes(batch.grains(), batch.capacity());
  const KernelUse use = prepare(kernel, threads, bytes);
  print_head(name, batch, threads, use, bytes);
  if (use.blocks == 0) {
    std::printf("does not fit\n");
    return;
  }
  const auto launch = [&] { kernel<<<batch.rves(), threads, bytes>>>(batch.list_arguments()); };
  launch();
  check(cudaDeviceSynchronize());
  const ListStore<Real> got = batch.download_lists();
  int same = 0;
  for (const int v : compared(batch.rves())) same += same_list(got, v, batch.reference(v), batch.grains());
  const float ms = run.times ? shortest_ms(run.repeats, launch) : 0;
  std::printf("%7.3f ms, %6.2f us an RVE and multiprocessor | %d of 3 RVEs have the host's bits\n", ms,
              1e3 * ms / std::max(1.0, batch.rves() / 132.0), same);
  std::fflush(stdout);
}

/// New lists of all RVEs, with the histories of the packing. The most pairs of an RVE are returned.
template <class Real>
int make_lists(const Batch<Real>& batch) {
  constexpr int threads = 256;
  const auto kernel = list_kernel<Real, threads, 8, 1>;
  const std::size_t bytes = list_bytes(batch.grains(), batch.capacity());
  prepare(kernel, threads, bytes);
  kernel<<<batch.rves(), threads, bytes>>>(batch.list_arguments());
  check(cudaDeviceSynchronize());
  return batch.most_pairs();
}

/// How many of three RVEs have the host's bits after 100 steps.
template <class Choice, class Launch>
int equal_states(const Batch<typename Choice::Real>& batch, const Run& run, const Launch& launch) {
  using Real = typename Choice::Real;
  constexpr int steps = 100;
  launch(steps);
  check(cudaDeviceSynchronize());
  int same = 0;
  for (const int v : compared(batch.rves())) {
    ListStore<Real> list = batch.reference(v);
    const StepState<Real> got = batch.download_state(v), want = reference_steps<Choice::rolling>(
                                                             list, batch.radii(), growth_of(v), literal_sand<Real>(),
                                                             steps, Choice::look == Look::none ? 0 : run.look_every);
    const bool looked = Choice::look == Look::none || std::memcmp(&got.report, &want.report, sizeof got.report) == 0;
    same += looked && std::memcmp(got.state.data(), want.state.data(), got.state.size() * sizeof(Quad<Real>)) == 0 &&
            std::memcmp(got.spin.data(), want.spin.data(), got.spin.size() * sizeof(Two<Real>)) == 0;
  }
  return same;
}

/// Steps of all RVEs from fresh lists: compares them after 100 steps, prints the rate.
template <class Choice>
void step_line(const char* name, const Batch<typename Choice::Real>& batch, const Run& run) {
  using Real = typename Choice::Real;
  if (std::strstr(name, run.only.c_str()) == nullptr) return;
  const int pairs = make_lists(batch);
  const auto kernel = step_kernel<Choice>;
  const std::size_t bytes = step_bytes<Choice>(batch.grains(), batch.capacity());
  const KernelUse use = prepare(kernel, Choice::threads, bytes);
  print_head(name, batch, Choice::threads, use, bytes);
  const bool fits = pairs <= Choice::threads * Choice::pair_slots && pairs <= batch.capacity() &&
                    batch.grains() <= Choice::threads * Choice::grain_slots &&
                    (Choice::gather != Gather::in_registers ||
                     most_pairs_of_a_grain(batch.reference(0), batch.grains()) <= most_in_registers);
  if (use.blocks == 0 || !fits) {
    std::printf("does not hold this packing\n");
    return;
  }
  const auto launch = [&](int steps) {
    kernel<<<batch.rves(), Choice::threads, bytes>>>(batch.step_arguments(steps, run.look_every));
  };
  const int same = equal_states<Choice>(batch, run, launch);
  if (run.times) {
    const float few = shortest_ms(run.repeats, [&] { launch(16); });
    const float all = shortest_ms(run.repeats, [&] { launch(run.steps); });
    const double work = 1e-6 * batch.rves() * batch.grains();
    std::printf("%8.3f ms, %6.2f G/s, steps alone %6.2f G/s, %7.2f us a step | ", all, work * run.steps / all,
                work * (run.steps - 16) / (all - few), 1e3 * (all - few) / (run.steps - 16));
  }
  std::printf("%d of 3 RVEs have the host's bits\n", same);
  std::fflush(stdout);
}

/// What one evaluation costs on the card, once its state is there: lists made anew and `evaluation_steps` steps with
/// looks. The histories of the packing go with the lists.
template <class Choice>
void evaluation_line(const char* name, const Batch<typename Choice::Real>& batch, const Run& run) {
  using Real = typename Choice::Real;
  if (std::strstr(name, run.only.c_str()) == nullptr || !run.times) return;
  constexpr int evaluation_steps = 118;  // the mean of cases/tunnel_quick
  constexpr int threads = 256, lanes = 4, blocks = 4;
  const auto lists = list_kernel<Real, threads, lanes, blocks>;
  const auto steps = step_kernel<Choice>;
  const std::size_t list_memory = list_bytes(batch.grains(), batch.capacity());
  const std::size_t step_memory = step_bytes<Choice>(batch.grains(), batch.capacity());
  prepare(lists, threads, list_memory);
  print_head(name, batch, Choice::threads, prepare(steps, Choice::threads, step_memory), step_memory);
  const float ms = shortest_ms(run.repeats, [&] {
    lists<<<batch.rves(), threads, list_memory>>>(batch.list_arguments());
    steps<<<batch.rves(), Choice::threads, step_memory>>>(batch.step_arguments(evaluation_steps, run.look_every));
  });
  std::printf("%8.3f ms for lists and %d steps, %6.2f G/s\n", ms, evaluation_steps,
              1e-6 * batch.rves() * batch.grains() * evaluation_steps / ms);
  std::fflush(stdout);
}

}  // namespace voussoir::gpu_step
