#include "io/packing_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "io/checksum.hpp"
#include "io/hdf5.hpp"

namespace voussoir::io {

namespace {

constexpr const char* format_name = "voussoir packing";
constexpr std::int64_t format_version = 1;

/// A sentence that says where the arrays disagree; empty when they agree.
std::string disagreement(const Packing& packing) {
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

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    parts.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

/// A checksum of the grains, the cell and the contacts together. Each array has a checksum of its own against damage;
/// this one tells a file that another program has changed.
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

void write_packing(Hdf5File& file, const Packing& packing) {
  const std::vector<std::size_t> grains{packing.grains()};
  const std::vector<std::size_t> contacts{packing.contacts()};
  file.set_attribute("/", "format", std::string(format_name));
  file.set_attribute("/", "format_version", format_version);
  file.set_attribute("/", "thickness", packing.thickness);
  file.set_attribute("/", "content", content_of(packing));
  file.write("/radius", packing.radius, grains, "m");
  file.write("/x", packing.x, grains, "m");
  file.write("/y", packing.y, grains, "m");
  file.write("/rotation", packing.rotation, grains, "rad");
  file.write("/cell", packing.cell, {2, 2}, "m");
  file.write("/contact_i", packing.contact_i, contacts, "-");
  file.write("/contact_j", packing.contact_j, contacts, "-");
  file.write("/history", packing.history, {packing.contacts(), packing.history_names.size()}, "SI");
  file.set_attribute("/history", "names", fmt::format("{}", fmt::join(packing.history_names, ",")));
  file.make_group("/numbers");
  for (const auto& [name, value] : packing.numbers) {
    file.set_attribute("/numbers", name, value);
  }
  file.make_group("/labels");
  for (const auto& [name, value] : packing.labels) {
    file.set_attribute("/labels", name, value);
  }
}

}  // namespace

void save_packing(const std::filesystem::path& path, const Packing& packing) {
  const std::string problem = disagreement(packing);
  if (!problem.empty()) {
    throw std::invalid_argument(fmt::format("packing for {}: {}", path.string(), problem));
  }
  if (path.has_parent_path()) {
    std::filesystem::create_directories(path.parent_path());
  }
  Hdf5File file = Hdf5File::create(path);
  write_packing(file, packing);
  file.publish();
}

Packing load_packing(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open(path);
  file.require_format(format_name, format_version, "a packing");
  Packing packing;
  packing.thickness = file.number_attribute("/", "thickness");
  packing.radius = file.read_doubles("/radius").values;
  packing.x = file.read_doubles("/x").values;
  packing.y = file.read_doubles("/y").values;
  packing.rotation = file.read_doubles("/rotation").values;
  const auto cell = file.read_doubles("/cell").values;
  if (cell.size() != packing.cell.size()) {
    throw std::runtime_error(fmt::format("{}: the cell has {} numbers instead of 4", path.string(), cell.size()));
  }
  std::copy(cell.begin(), cell.end(), packing.cell.begin());
  packing.contact_i = file.read_integers("/contact_i").values;
  packing.contact_j = file.read_integers("/contact_j").values;
  packing.history = file.read_doubles("/history").values;
  packing.history_names = split(file.text_attribute("/history", "names"));
  for (const auto& name : file.attributes("/numbers")) {
    packing.numbers[name] = file.number_attribute("/numbers", name);
  }
  for (const auto& name : file.attributes("/labels")) {
    packing.labels[name] = file.text_attribute("/labels", name);
  }
  const std::string problem = disagreement(packing);
  if (!problem.empty()) {
    throw std::runtime_error(fmt::format("{}: {}", path.string(), problem));
  }
  const std::vector<std::string> known = file.attributes("/");
  const bool tells = std::find(known.begin(), known.end(), "content") != known.end();  // older files do not
  if (tells && file.integer_attribute("/", "content") != content_of(packing)) {
    throw std::runtime_error(
        fmt::format("{}: its grains were changed after this program had written them; a packing of your own has no "
                    "attribute content",
                    path.string()));
  }
  return packing;
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
