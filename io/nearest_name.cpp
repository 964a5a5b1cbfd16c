#include "io/nearest_name.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace voussoir::io {

namespace {

/// The Levenshtein distance of two names.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(const std::vector<std::string>& names, std::string_view wanted) {
  std::size_t best = wanted.size() / 3 + 1;
  std::string nearest;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(name, wanted);
    if (distance <= best) {
      best = distance;
      nearest = name;
    }
  }
  return nearest;
}

}  // namespace voussoir::io
