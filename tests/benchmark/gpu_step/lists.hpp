#pragma once
/// Lists from a cell grid by one team an RVE. Threads fill bins and rows in an order that is open, by atomic additions
/// to counters in shared memory; then each row is sorted, so that the list never depends on that order.

#include "tests/benchmark/gpu_step/pair_lists.hpp"
#include "tests/benchmark/gpu_step/real.hpp"

namespace voussoir::gpu_step {

template <class Real>
struct ListArguments {
  int grains;              ///< at most 65535
  double skin;             ///< pairs closer than r_i + r_j + skin are listed [m]
  const double* position;  ///< (rve, grains, 2) any image [m]
  const Mat2* cell;        ///< (rve) columns are the periodic vectors, reduced (kernels/contact/cell.hpp) [m]
  const double* radius;    ///< (grains) [m]
  /// Histories of contacts so far: (rve, kept_capacity), ascending keys i << 16 | j, at most `lists.capacity` of them.
  const std::uint32_t* kept;
  const Two<double>* kept_history;  ///< [N], [N m]
  const int* kept_count;            ///< (rve)
  int kept_capacity;
  PairLists<Real> lists;  ///< written, with histories of kept contacts and zeros elsewhere
};

/// A periodic cell and the grid of bins over it. Bins are about as wide as the mean grain: a grain of any size looks
/// through the bins within its own reach.
struct Grid {
  Mat2 h, inverse;
  double height_x, height_y;  ///< distances between opposite sides [m]
  int nx, ny;

  VOUSSOIR_DEVICE Grid(const Mat2& cell, int grains) : h(cell) {
    const double s = 1.0 / (h.xx * h.yy - h.xy * h.yx);
    inverse = {s * h.yy, s * -h.xy, s * -h.yx, s * h.xx};
    height_x = 1.0 / std::sqrt(inverse.xx * inverse.xx + inverse.xy * inverse.xy);
    height_y = 1.0 / std::sqrt(inverse.yx * inverse.yx + inverse.yy * inverse.yy);
    const double width = std::sqrt(height_x * height_y / grains);
    const double n = grains;  // nx ny <= n: if one of them was raised to 1, the other is not above n
    nx = static_cast<int>(least(n, most(1.0, std::floor(height_x / width))));
    ny = static_cast<int>(least(n, most(1.0, std::floor(height_y / width))));
  }

  /// The image inside the cell, as kernels/contact/cell.hpp has it.
  VOUSSOIR_DEVICE void wrap(double& x, double& y) const {
    const double a = std::floor(inverse.xx * x + inverse.xy * y), b = std::floor(inverse.yx * x + inverse.yy * y);
    x -= h.xx * a + h.xy * b;
    y -= h.yx * a + h.yy * b;
  }
  /// The nearest image of a difference vector, likewise.
  VOUSSOIR_DEVICE void nearest(double& dx, double& dy) const {
    const double a = std::rint(inverse.xx * dx + inverse.xy * dy), b = std::rint(inverse.yx * dx + inverse.yy * dy);
    dx -= h.xx * a + h.xy * b;
    dy -= h.yx * a + h.yy * b;
  }
  /// The place of a point of the cell in bins, from 0 to nx and to ny; 0 for what is no number.
  [[nodiscard]] VOUSSOIR_DEVICE Two<double> slots(double x, double y) const {
    return {least(most((inverse.xx * x + inverse.xy * y) * nx, 0.0), 1.0 * nx),
            least(most((inverse.yx * x + inverse.yy * y) * ny, 0.0), 1.0 * ny)};
  }
};

/// An RVE's arrays in shared memory.
struct ListMemory {
  double *x, *y, *radius;            ///< (grains) of the members of the bins, bin after bin, inside the cell
  int* counter;                      ///< (grains + 1) of each bin, later of each row
  int* incoming_counter;             ///< (grains + 1)
  int* warp_sum;                     ///< (32)
  int* hits;                         ///< 1
  std::uint32_t *hit, *key;          ///< (capacity) pairs as they were found; sorted
  std::uint16_t *member, *incoming;  ///< (grains), (capacity)
};

VOUSSOIR_DEVICE ListMemory carve_lists(Carver& carver, int grains, int capacity) {
  ListMemory m{};
  m.x = carver.take<double>(grains);
  m.y = carver.take<double>(grains);
  m.radius = carver.take<double>(grains);
  m.counter = carver.take<int>(grains + 1);
  m.incoming_counter = carver.take<int>(grains + 1);
  m.warp_sum = carver.take<int>(32);
  m.hits = carver.take<int>(1);
  m.hit = carver.take<std::uint32_t>(capacity);
  m.key = carver.take<std::uint32_t>(capacity);
  m.member = carver.take<std::uint16_t>(grains);
  m.incoming = carver.take<std::uint16_t>(capacity);
  return m;
}

inline std::size_t list_bytes(int grains, int capacity) {
  Carver carver(nullptr);
  carve_lists(carver, grains, capacity);
  return carver.bytes();
}

/// Insertion sort: rows are short.
template <class T>
VOUSSOIR_DEVICE void sort_row(T* row, int count) {
  for (int k = 1; k < count; ++k) {
    const T own = row[k];
    int at = k;
    for (; at > 0 && row[at - 1] > own; --at) row[at] = row[at - 1];
    row[at] = own;
  }
}

/// One thread's share of an RVE. @tparam lanes threads that search for one grain's neighbours together
template <class Real, int lanes, class Team>
class ListThread {
 public:
  VOUSSOIR_DEVICE ListThread(const Team& team, const ListArguments<Real>& a)
      : team_(team),
        a_(a),
        grid_(a.cell[team.rve()], a.grains),
        rank_(team.rank()),
        first_(static_cast<std::size_t>(team.rve()) * static_cast<std::size_t>(a.lists.capacity)),
        row_first_(static_cast<std::size_t>(team.rve()) * static_cast<std::size_t>(a.grains + 1)),
        position_(a.position + 2 * static_cast<std::size_t>(team.rve()) * static_cast<std::size_t>(a.grains)) {
    Carver carver(team.shared());
    m_ = carve_lists(carver, a.grains, a.lists.capacity);
  }

  VOUSSOIR_DEVICE void run() {
    fill_bins();
    search();
    const int pairs = *m_.hits;
    if (rank_ == 0) a_.lists.pair_count[team_.rve()] = pairs;
    if (pairs > a_.lists.capacity) return;
    sort_pairs(pairs);
    write_pairs(pairs);
    write_incoming(pairs);
  }

 private:
  static constexpr int threads = Team::threads;

  /// Turns counts into where each entry begins; entry `count` becomes the sum.
  VOUSSOIR_DEVICE void sums_before(int* counts, int count) {
    const int share = (count + threads) / threads, from = rank_ * share;
    int own = 0;
    for (int k = from; k < from + share && k < count; ++k) own += counts[k];
    const int before = team_.warp_sum_before(own);
    if (rank_ % 32 == 31) m_.warp_sum[rank_ / 32] = before + own;
    team_.barrier();
    int sum = before;
    for (int w = 0; w < rank_ / 32; ++w) sum += m_.warp_sum[w];
    for (int k = from; k < from + share && k <= count; ++k) {
      const int one = k < count ? counts[k] : 0;
      counts[k] = sum;
      sum += one;
    }
    team_.barrier();
  }

  /// Where a row or bin begins once its counter has run to its end.
  [[nodiscard]] static VOUSSOIR_DEVICE int begin_of(const int* counter, int k) { return k == 0 ? 0 : counter[k - 1]; }

  [[nodiscard]] VOUSSOIR_DEVICE int bin_of(double x, double y) const {
    const Two<double> s = grid_.slots(x, y);
    return static_cast<int>(least(s.y, grid_.ny - 1.0)) * grid_.nx + static_cast<int>(least(s.x, grid_.nx - 1.0));
  }

  VOUSSOIR_DEVICE void fill_bins() {
    const int bins = grid_.nx * grid_.ny;
    // NOLINTBEGIN(clang-analyzer-core.NullDereference): the launch has given the team as much memory as `carve_lists`
    // takes.
    for (int k = rank_; k <= bins; k += threads) m_.counter[k] = 0;
    if (rank_ == 0) *m_.hits = 0;
    // NOLINTEND(clang-analyzer-core.NullDereference)
    team_.barrier();
    for (int i = rank_; i < a_.grains; i += threads) {
      double x = position_[2 * i], y = position_[2 * i + 1];
      grid_.wrap(x, y);
      team_.add(m_.counter[bin_of(x, y)], 1);
    }
    team_.barrier();
    sums_before(m_.counter, bins);
    for (int i = rank_; i < a_.grains; i += threads) {
      double x = position_[2 * i], y = position_[2 * i + 1];
      grid_.wrap(x, y);
      const int at = team_.add(m_.counter[bin_of(x, y)], 1);
      m_.x[at] = x;
      m_.y[at] = y;
      m_.radius[at] = a_.radius[i];
      m_.member[at] = static_cast<std::uint16_t>(i);
    }
    team_.barrier();
  }

  /// Each grain looks for those that are smaller, or as large and of a higher index.
  VOUSSOIR_DEVICE void search() {
    for (int at = rank_ / lanes; at < a_.grains; at += threads / lanes) {
      const double reach = (1.0 + 1e-12) * (2.0 * m_.radius[at] + a_.skin);  // more than all errors of rounding
      const Two<double> s = grid_.slots(m_.x[at], m_.y[at]);
      const double wx = reach / grid_.height_x * grid_.nx, wy = reach / grid_.height_y * grid_.ny;
      const int left = slot(s.x - wx, grid_.nx), right = slot(s.x + wx, grid_.nx), top = slot(s.y + wy, grid_.ny);
      for (int row = slot(s.y - wy, grid_.ny); row <= top; ++row) search_row(at, row, left, right);
    }
    team_.barrier();
  }

  /// A bin of the cell or of its next images.
  [[nodiscard]] static VOUSSOIR_DEVICE int slot(double at, int bins) {
    return static_cast<int>(least(most(std::floor(at), -1.0 * bins), 2.0 * bins - 1.0));
  }

  /// Bins left .. right of a row; those beyond the cell are images. As a cell is wider than twice the largest reach,
  /// no pair is found by two images.
  VOUSSOIR_DEVICE void search_row(int at, int row, int left, int right) {
    const int v = row < 0 ? -1 : row >= grid_.ny ? 1 : 0, first_bin = (row - v * grid_.ny) * grid_.nx;
    for (int u = left < 0 ? -1 : 0; u <= (right >= grid_.nx ? 1 : 0); ++u) {
      const int from = u < 0 ? left + grid_.nx : u > 0 ? 0 : (left < 0 ? 0 : left);
      const int to = u < 0 ? grid_.nx - 1 : u > 0 ? right - grid_.nx : (right < grid_.nx ? right : grid_.nx - 1);
      const double x = m_.x[at] - (grid_.h.xx * u + grid_.h.xy * v), y = m_.y[at] - (grid_.h.yx * u + grid_.h.yy * v);
      const int end = m_.counter[first_bin + to];
      for (int k = begin_of(m_.counter, first_bin + from) + rank_ % lanes; k < end; k += lanes) meet(at, k, x, y);
    }
  }

  VOUSSOIR_DEVICE void meet(int at, int k, double x, double y) {
    const double own = m_.radius[at], other = m_.radius[k], reach = own + other + a_.skin;
    const double dx = m_.x[k] - x, dy = m_.y[k] - y;
    if (!(dx * dx + dy * dy < reach * reach) || other > own) return;  // nor does it meet what is no number
    const std::uint32_t i = m_.member[at], j = m_.member[k];
    if (other == own && j <= i) return;
    const int hit = team_.add(*m_.hits, 1);
    if (hit < a_.lists.capacity) m_.hit[hit] = i < j ? i << 16 | j : j << 16 | i;
  }

  /// Sorts the pairs by i with counters, and each row by j.
  VOUSSOIR_DEVICE void sort_pairs(int pairs) {
    for (int i = rank_; i <= a_.grains; i += threads) m_.counter[i] = m_.incoming_counter[i] = 0;
    team_.barrier();
    for (int p = rank_; p < pairs; p += threads) {
      team_.add(m_.counter[m_.hit[p] >> 16], 1);
      team_.add(m_.incoming_counter[m_.hit[p] & 0xffffU], 1);
    }
    team_.barrier();
    sums_before(m_.counter, a_.grains);
    sums_before(m_.incoming_counter, a_.grains);
    for (int i = rank_; i <= a_.grains; i += threads) {
      a_.lists.row[row_first_ + static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(m_.counter[i]);
      a_.lists.incoming_row[row_first_ + static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(
          m_.incoming_counter[i]);
    }
    team_.barrier();
    for (int p = rank_; p < pairs; p += threads) m_.key[team_.add(m_.counter[m_.hit[p] >> 16], 1)] = m_.hit[p];
    team_.barrier();
    const int kept = a_.kept_count[team_.rve()];  // the unsorted pairs make room for the keys of kept contacts
    for (int c = rank_; c < kept; c += threads) m_.hit[c] = a_.kept[kept_first() + static_cast<std::size_t>(c)];
    for (int i = rank_; i < a_.grains; i += threads) {
      const int begin = begin_of(m_.counter, i);
      sort_row(m_.key + begin, m_.counter[i] - begin);
    }
    team_.barrier();
  }

  [[nodiscard]] VOUSSOIR_DEVICE std::size_t kept_first() const {
    return static_cast<std::size_t>(team_.rve()) * static_cast<std::size_t>(a_.kept_capacity);
  }

  /// Branches and gaps in double, rounded once (kernels/contact/pair_reference.hpp); incoming pairs to their rows.
  VOUSSOIR_DEVICE void write_pairs(int pairs) {
    const int kept = a_.kept_count[team_.rve()];
    for (int p = rank_; p < pairs; p += threads) {
      const std::uint32_t key = m_.key[p];
      const int i = static_cast<int>(key >> 16), j = static_cast<int>(key & 0xffffU);
      double dx = position_[2 * j] - position_[2 * i], dy = position_[2 * j + 1] - position_[2 * i + 1];
      grid_.nearest(dx, dy);
      const double sum = a_.radius[i] + a_.radius[j];
      const std::size_t at = first_ + static_cast<std::size_t>(p);
      a_.lists.grains[at] = key;
      a_.lists.branch_x[at] = static_cast<Real>(dx);
      a_.lists.branch_y[at] = static_cast<Real>(dy);
      a_.lists.gap[at] = static_cast<Real>(dx * dx + dy * dy - sum * sum);
      const Two<double> history = history_of(key, kept);
      a_.lists.tangential[at] = static_cast<Real>(history.x);
      a_.lists.moment[at] = static_cast<Real>(history.y);
      m_.incoming[team_.add(m_.incoming_counter[j], 1)] = static_cast<std::uint16_t>(p);
    }
    team_.barrier();
  }

  /// By bisection of the kept contacts.
  [[nodiscard]] VOUSSOIR_DEVICE Two<double> history_of(std::uint32_t key, int kept) const {
    int from = 0, to = kept;
    while (from < to) {
      const int middle = (from + to) / 2;
      if (m_.hit[middle] < key) {
        from = middle + 1;
      } else {
        to = middle;
      }
    }
    if (from == kept || m_.hit[from] != key) return {0, 0};
    return a_.kept_history[kept_first() + static_cast<std::size_t>(from)];
  }

  VOUSSOIR_DEVICE void write_incoming(int pairs) {
    for (int i = rank_; i < a_.grains; i += threads) {
      const int begin = begin_of(m_.incoming_counter, i);
      sort_row(m_.incoming + begin, m_.incoming_counter[i] - begin);
    }
    team_.barrier();
    for (int p = rank_; p < pairs; p += threads) {
      a_.lists.incoming[first_ + static_cast<std::size_t>(p)] = m_.incoming[p];
    }
  }

  const Team& team_;
  const ListArguments<Real>& a_;
  Grid grid_;
  int rank_;
  std::size_t first_, row_first_;
  const double* position_;
  ListMemory m_;
};

}  // namespace voussoir::gpu_step
