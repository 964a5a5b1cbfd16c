#include "io/packing_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "io/checksum.hpp"

namespace voussoir::io {

std::string disagreement_of(const Packing& packing) {
  const std::size_t n = packing.grains();
  if (n == 0) {
    return "has no grains";
  }
  if (packing.x.size() != n || packing.y.size() != n || packing.rotation.size() != n) {
    return fmt::format("has {} radii, but {} x, {} y, {} rotations", n, packing.x.size(), packing.y.size(),
                       packing.rotation.size());
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (!(packing.radius[i] > 0) ||
        !std::isfinite(packing.radius[i] + packing.x[i] + packing.y[i] + packing.rotation[i])) {
      return fmt::format("grain {} has a radius that is not positive, or a value that is not finite", i);
    }
  }
  if (packing.contact_j.size() != packing.contacts() ||
      packing.history.size() != packing.contacts() * packing.history_names.size()) {
    return "its contact arrays differ in length";
  }
  for (std::size_t c = 0; c < packing.contacts(); ++c) {
    const auto count = static_cast<std::int64_t>(n);
    const auto i = packing.contact_i[c];
    const auto j = packing.contact_j[c];
    if (i < 0 || j < 0 || i >= count || j >= count) {
      return fmt::format("contact {} joins grains {} and {}, but there are {} grains", c, i, j, n);
    }
  }
  return "";
}

std::int64_t content_of(const Packing& packing) {
  Checksum sum;
  const auto add = [&sum](const auto& values) { sum.add(std::as_bytes(std::span(values))); };
  add(packing.radius);
  add(packing.x);
  add(packing.y);
  add(packing.rotation);
  add(packing.cell);
  add(std::array{packing.thickness});
  add(packing.contact_i);
  add(packing.contact_j);
  add(packing.history);
  return static_cast<std::int64_t>(sum.value());
}

void require_agreement(const std::filesystem::path& path, const Packing& packing, std::optional<std::int64_t> content) {
  const std::string problem = disagreement_of(packing);
  if (!problem.empty()) {
    throw std::runtime_error(fmt::format("{}: {}", path.string(), problem));
  }
  if (content && *content != content_of(packing)) {
    throw std::runtime_error(
        fmt::format("{}: its grains were changed after this program had written them; a packing of your own has no "
                    "attribute content",
                    path.string()));
  }
}

Packing load_any_packing(const std::filesystem::path& path) {
  return path.extension() == ".h5" ? load_packing(path) : load_packing_csv(path);
}

std::filesystem::path packing_path(const std::filesystem::path& folder, const std::string& recipe_fingerprint) {
  return folder / fmt::format("packing_{}.h5", recipe_fingerprint);
}

std::optional<Packing> find_packing(const std::filesystem::path& folder, const std::string& recipe_fingerprint) {
  const auto path = packing_path(folder, recipe_fingerprint);
  if (!std::filesystem::exists(path)) {
    return std::nullopt;
  }
  try {
    Packing packing = load_packing(path);
    const auto label = packing.labels.find("recipe_fingerprint");
    if (label != packing.labels.end() && label->second == recipe_fingerprint) {
      return packing;
    }
    // NOLINTNEXTLINE(bugprone-empty-catch): the return below is the answer.
  } catch (const std::exception&) {
    // A cache may be damaged without harm: the packing is made again and replaces it.
  }
  return std::nullopt;
}

}  // namespace voussoir::io
