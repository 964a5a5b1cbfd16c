#include "io/near_names.hpp"

#include <algorithm>
#include <compare>
#include <limits>
#include <numeric>
#include <utility>

#include "io/key_reference.hpp"

namespace voussoir::io {

std::size_t most_distance(std::string_view name) { return name.size() / 3 + 1; }

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

namespace {

/// One name is the beginning of the other one, as of "friction" and "friction_angle", within the same table.
bool continues(std::string_view longer, std::string_view shorter) {
  constexpr std::size_t least = 4;
  if (longer.size() < shorter.size()) std::swap(longer, shorter);
  return shorter.size() >= least && longer.starts_with(shorter) &&
         longer.find('.', shorter.size()) == std::string_view::npos;
}

/// How far a name is from a wanted one; the smaller one of two is nearer.
struct Nearness {
  std::size_t distance = 0;  ///< the edit distance, or half of the largest one where one name continues the other
  std::size_t letters = 0;   ///< the edit distance, which decides where two names are equally far: "size" is "sizes"
                             ///< and not "size_maximum"
  auto operator<=>(const Nearness&) const = default;
};

Nearness nearness(std::string_view name, std::string_view wanted) {
  const std::size_t letters = edit_distance(name, wanted);
  return {continues(name, wanted) ? std::min(letters, most_distance(wanted) / 2) : letters, letters};
}

}  // namespace

std::string nearest_name(const std::vector<std::string>& names, std::string_view wanted) {
  Nearness best{most_distance(wanted), std::numeric_limits<std::size_t>::max()};
  std::string nearest;
  for (const std::string& name : names) {
    const Nearness near = nearness(name, wanted);
    if (near <= best) {
      best = near;
      nearest = name;
    }
  }
  return nearest;
}

std::vector<std::string> near_names(const std::string& wanted, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 100, most_names = 5;
  if (wanted.size() > longest) return {};
  const bool has_table = wanted.find('.') != std::string::npos;
  std::vector<std::pair<Nearness, std::string>> found;
  for (const std::string& name : known) {
    Nearness near = nearness(name, wanted);
    if (!has_table) near = std::min(near, nearness(last_part(name), wanted));
    if (near.distance <= most_distance(wanted)) found.emplace_back(near, name);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  // Where one name is a letter or two away, those at twice its distance and more are no longer meant.
  std::vector<std::string> names;
  for (auto& [near, name] : found) {
    if (names.size() == most_names || near.distance > 2 * found.front().first.distance) break;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
  }
  return names;
}

}  // namespace voussoir::io
