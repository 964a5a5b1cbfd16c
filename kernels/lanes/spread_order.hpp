#pragma once
/// How the grains and pairs of one RVE that is spread over lanes lie in vectors. A vector of grains has the row of each
/// grain in its lane: its k-th vector of pairs holds the k-th pair of each of these rows. A grain therefore meets its
/// pairs in its own lane, and adds their forces up in the order of its row. The pairs in which a grain stands second
/// are found by a list, in the order of the rows too. Lanes whose row or list is shorter than the longest of their
/// vector are idle there; so grains are sorted by these lengths, within windows of some vectors, which end in the order
/// of the grains: what has to be summed grain by grain or pair by pair can follow a window behind.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "kernels/lanes/wide_lane.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

template <std::size_t width>
class SpreadOrder {
 public:
  static constexpr std::size_t window = 16;  ///< vectors of grains

  /// A vector of grains. Its pairs and lists end where those of the next one begin.
  struct Block {
    std::size_t pairs = 0;    ///< the first vector of pairs
    std::size_t seconds = 0;  ///< the first line of the list of pairs in which the grains stand second
    std::size_t whole = 0;    ///< pairs in the rows of all windows before
  };

  /// @param rows where the pairs of each grain begin in the list, and its end
  /// @param other_of gives the second grain of a pair
  template <class OtherOf>
  void make(std::span<const int> rows, const OtherOf& other_of) {
    const std::size_t n = rows.size() - 1, pairs = static_cast<std::size_t>(rows.back());
    count_seconds(n, pairs, other_of);
    sort_grains(rows, n);
    make_blocks(rows, n);
    slots_.resize(pairs);
    seconds_.assign(blocks_.back().seconds * width, static_cast<std::int32_t>(no_slot()));
    std::fill(second_count_.begin(), second_count_.end(), 0);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t at = places_[i], first = static_cast<std::size_t>(rows[i]);
      for (std::size_t p = first; p < static_cast<std::size_t>(rows[i + 1]); ++p) {
        slots_[p] = (blocks_[at / width].pairs + p - first) * width + at % width;
        const auto j = static_cast<std::size_t>(other_of(p));
        const std::size_t line = blocks_[places_[j] / width].seconds + static_cast<std::size_t>(second_count_[j]++);
        seconds_[line * width + places_[j] % width] = static_cast<std::int32_t>(slots_[p]);
      }
    }
  }

  /// One more than there are vectors of grains; the last one is the end.
  [[nodiscard]] std::span<const Block> blocks() const { return blocks_; }
  [[nodiscard]] std::size_t pair_blocks() const { return blocks_.back().pairs; }
  [[nodiscard]] std::span<const std::size_t> places() const { return places_; }     ///< by grain: its lane of all lanes
  [[nodiscard]] std::span<const std::size_t> slots() const { return slots_; }       ///< by pair: its lane of all lanes
  [[nodiscard]] std::span<const std::int32_t> seconds() const { return seconds_; }  ///< slots, or no_slot()
  /// A lane behind those of all pairs.
  [[nodiscard]] std::size_t no_slot() const { return pair_blocks() * width; }

 private:
  std::vector<Block> blocks_;
  std::vector<std::size_t> places_, slots_;
  std::vector<std::int32_t> seconds_;
  std::vector<int> second_count_;
  std::vector<std::size_t> sorted_;

  template <class OtherOf>
  void count_seconds(std::size_t n, std::size_t pairs, const OtherOf& other_of) {
    second_count_.assign(n, 0);
    for (std::size_t p = 0; p < pairs; ++p) ++second_count_[static_cast<std::size_t>(other_of(p))];
  }

  void sort_grains(std::span<const int> rows, std::size_t n) {
    sorted_.resize(n);
    std::iota(sorted_.begin(), sorted_.end(), std::size_t{0});
    const auto key = [&](std::size_t i) { return ((rows[i + 1] - rows[i]) << 16) + second_count_[i]; };
    for (std::size_t begin = 0; begin < n; begin += window * width) {
      std::stable_sort(sorted_.begin() + static_cast<std::ptrdiff_t>(begin),
                       sorted_.begin() + static_cast<std::ptrdiff_t>(std::min(begin + window * width, n)),
                       [&](std::size_t a, std::size_t b) { return key(a) > key(b); });
    }
    places_.resize(n);
    for (std::size_t k = 0; k < n; ++k) places_[sorted_[k]] = k;
  }

  void make_blocks(std::span<const int> rows, std::size_t n) {
    blocks_.assign((n + width - 1) / width + 1, {});
    for (std::size_t b = 0; b + 1 < blocks_.size(); ++b) {
      int longest = 0, most_seconds = 0;
      for (std::size_t k = b * width; k < std::min((b + 1) * width, n); ++k) {
        const std::size_t i = sorted_[k];
        longest = std::max(longest, rows[i + 1] - rows[i]);
        most_seconds = std::max(most_seconds, second_count_[i]);
      }
      blocks_[b + 1].pairs = blocks_[b].pairs + static_cast<std::size_t>(longest);
      blocks_[b + 1].seconds = blocks_[b].seconds + static_cast<std::size_t>(most_seconds);
      blocks_[b].whole = static_cast<std::size_t>(rows[b / window * window * width]);
    }
    blocks_.back().whole = static_cast<std::size_t>(rows[n]);
  }
};

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
