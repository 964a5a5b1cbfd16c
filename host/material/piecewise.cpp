#include "host/material/piecewise.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace voussoir::host {
namespace {

/// Pieces are made of as many whole groups of lanes as possible; the widest lanes take so many RVEs.
constexpr std::size_t widest_group = 16;

/// Steps of grains that an RVE is expected to take, for which form_groups sorts the RVEs, too.
double predicted_work(const kernels::RveBatch& batch, const kernels::StrainRequest& request,
                      const kernels::RveReport& report, std::size_t rve) {
  return static_cast<double>(kernels::predicted_steps(request, report.steps)) * batch.packing(rve).size();
}

/// The work of two calls, one after the other.
void add_later(kernels::Work& sum, const kernels::Work& piece) {
  const std::size_t workers = std::max(sum.workers, piece.workers);
  sum += piece;
  sum.workers = workers;
}

}  // namespace

kernels::Work Piecewise::advance(kernels::RveBatch& batch, std::span<const kernels::StrainRequest> requests,
                                 const kernels::EngineSettings& settings, std::span<kernels::RveReport> reports,
                                 std::span<const int> rves) {
  if (!pause_) return kernels::advance(batch, requests, settings, reports, rves);
  const auto work_of = [&](int rve) {
    const auto k = static_cast<std::size_t>(rve);
    return predicted_work(batch, requests[k], reports[k], k);
  };
  const auto packing_of = [&](int rve) { return batch.packing_of[static_cast<std::size_t>(rve)]; };
  // A group has RVEs of one packing, so that pieces in the order of the points would leave lanes empty.
  std::vector<int> order(rves.begin(), rves.end());
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return packing_of(a) < packing_of(b); });
  kernels::Work sum;
  for (std::span<const int> left(order); !left.empty();) {
    double all = 0;
    for (const int rve : left) all += work_of(rve);
    const double pieces = std::max(1.0, std::round(all * rate_ / seconds_));
    double work = 0;
    std::size_t n = 0;
    while (n < left.size() && (pieces == 1 || work < all / pieces || n % widest_group != 0)) work += work_of(left[n++]);
    const auto begin = std::chrono::steady_clock::now();
    kernels::Work done;
    const auto piece = [&] { done = kernels::advance(batch, requests, settings, reports, left.first(n)); };
    if (watched_ && work * rate_ > 2 * seconds_) {
      watched_(piece);
    } else {
      piece();
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    if (work > 0) rate_ = seconds.count() / work;
    add_later(sum, done);
    left = left.subspan(n);
    pause_();
  }
  return sum;
}

}  // namespace voussoir::host
