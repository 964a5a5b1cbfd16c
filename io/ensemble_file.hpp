#pragma once
/// Results of an ensemble in a folder: fields/NNNN.h5 (the bands of the fields of one increment) and ensemble.h5
/// (everything else, and links). docs/reference/files.md lists every dataset.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/result_data.hpp"

namespace voussoir::io {

/// Mean and bands of an array of numbers over the members of an ensemble. The bands are mean +- half width.
struct Bands {
  std::string name = {};
  std::string unit = "-";
  std::vector<std::size_t> shape = {};
  std::vector<double> mean = {};
  std::vector<double> deviation = {};              ///< standard deviation over the members, with n - 1
  std::vector<double> mean_half_width = {};        ///< of the 95 % band of the mean
  std::vector<double> prediction_half_width = {};  ///< of the 95 % band of a further member
  std::vector<double> members = {};                ///< (member, shape...) the values themselves; empty: not kept
};

struct EnsembleMember {
  std::string name = {};
  std::int64_t seed = 0;    ///< the first of its seeds
  std::string status = {};  ///< how its run ended
  int exit_code = 0;
  bool reduced = false;  ///< it is among the members over which the results are reduced
};

/// One increment that all reduced members have.
struct EnsembleIncrement {
  int index = 0;  ///< number of the increment's file
  std::string stage = {};
  int stage_index = 0;
  double load_parameter = 0;  ///< [-]
  int converged = 0;          ///< reduced members whose increment is converged
  int good_troughs = 0;       ///< reduced members whose surface trough has the shape of the modified Gauss curve
};

/// What `--until` asked for, and what was reached.
struct EnsembleGoal {
  std::string result = {};
  double wanted = 0;   ///< standard error over |mean| [-]
  double reached = 0;  ///< [-]
};

struct EnsembleData {
  Provenance provenance = {};
  MeshData mesh = {};
  std::vector<EnsembleMember> members = {};
  int seeds_of_a_member = 1;
  int reduced = 0;               ///< number of members over which the results are reduced
  double confidence = 0.95;      ///< of both bands
  double student_t = 0;          ///< quantile for `reduced` - 1 degrees of freedom
  double mean_factor = 0;        ///< half width of the mean's band over the deviation
  double prediction_factor = 0;  ///< half width of the prediction's band over the deviation
  std::vector<EnsembleIncrement> increments = {};
  std::vector<Bands> curves = {};  ///< (increment)
  std::map<std::string, std::vector<Bands>> tables = {};
  std::vector<double> trough_x = {};  ///< distance of the surface's nodes from the axis [m]
  std::optional<Bands> trough = {};   ///< (increment, node) settlements of these nodes [m]
  std::optional<EnsembleGoal> goal = {};
};

/// Path of the bands of an increment's fields below the ensemble's folder.
[[nodiscard]] std::filesystem::path ensemble_fields_path(const std::filesystem::path& folder, int index);

/// Writes ensemble.h5 with links to the fields of all increments. It and the next function throw std::runtime_error
/// naming file and reason.
void write_ensemble(const std::filesystem::path& folder, const EnsembleData& data);

/// Writes the bands of an increment's fields, each with the field's location.
void write_ensemble_fields(const std::filesystem::path& folder, const EnsembleIncrement& increment, int members,
                           const std::vector<std::pair<FieldLocation, Bands>>& fields);

}  // namespace voussoir::io
