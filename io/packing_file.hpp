#pragma once
/// Packings of grains on disk. A packing is made only once, and packings of other programs can be read.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace voussoir::io {

/// One periodic packing. Contact histories are kept as the caller names them: history[contact * names.size() + k].
struct Packing {
  std::vector<double> radius = {};     ///< [m]
  std::vector<double> x = {}, y = {};  ///< centres [m]
  std::vector<double> rotation = {};   ///< [rad]
  std::array<double, 4> cell = {};     ///< [a_x b_x; a_y b_y] row by row, cell vectors are columns [m]
  double thickness = 0.1;              ///< out-of-plane [m]
  std::vector<std::int64_t> contact_i = {}, contact_j = {};
  std::vector<std::string> history_names = {};
  std::vector<double> history = {};                ///< (contact, history_names)
  std::map<std::string, double> numbers = {};      ///< void_ratio [-], pressure [Pa], seed, ... (SI)
  std::map<std::string, std::string> labels = {};  ///< recipe, recipe_fingerprint, soil, ...

  [[nodiscard]] std::size_t grains() const { return radius.size(); }
  [[nodiscard]] std::size_t contacts() const { return contact_i.size(); }
};

inline constexpr const char* packing_format = "voussoir packing";  ///< attribute `format` of a packing's file
inline constexpr std::int64_t packing_format_version = 1;

/// A sentence that says where the arrays disagree; empty when they agree.
[[nodiscard]] std::string disagreement_of(const Packing& packing);

/// A checksum of the grains, the cell and the contacts together, which the file keeps. Each array has a checksum of its
/// own against damage; this one tells a file that another program has changed.
[[nodiscard]] std::int64_t content_of(const Packing& packing);

/// Throws std::runtime_error where the arrays of a file disagree, or where its checksum is not `content`.
/// @param content that the file tells; none: an older file, or one of another program
void require_agreement(const std::filesystem::path& path, const Packing& packing, std::optional<std::int64_t> content);

/// Writes an HDF5 file (docs/reference/files.md) through a temporary name. Throws std::invalid_argument when sizes
/// disagree, std::runtime_error when the file cannot be written.
void save_packing(const std::filesystem::path& path, const Packing& packing);

/// Reads a file of save_packing. Throws std::runtime_error where the file is missing, damaged or no packing, or where
/// sizes disagree.
[[nodiscard]] Packing load_packing(const std::filesystem::path& path);

/// Reads NAME_particles.csv (id,x_m,y_m,r_m,theta_z_rad) and NAME_meta.json beside it (hSize: cell vectors as columns,
/// Lz or hSize[2][2]: thickness); `path` is either file. Other numbers of the JSON file go to `numbers`, texts to
/// `labels`. The packing has no contact histories. Throws std::runtime_error naming file and line.
[[nodiscard]] Packing load_packing_csv(const std::filesystem::path& path);

/// Reads a file of either kind: load_packing for names that end in ".h5", load_packing_csv for others.
[[nodiscard]] Packing load_any_packing(const std::filesystem::path& path);

/// Name of the cached packing of a recipe: FOLDER/packing_FINGERPRINT.h5.
[[nodiscard]] std::filesystem::path packing_path(const std::filesystem::path& folder,
                                                 const std::string& recipe_fingerprint);

/// The cached packing; no value when it is missing or damaged, or when its label "recipe_fingerprint" differs.
[[nodiscard]] std::optional<Packing> find_packing(const std::filesystem::path& folder,
                                                  const std::string& recipe_fingerprint);

}  // namespace voussoir::io
