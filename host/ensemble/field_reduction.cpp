// The fields of an ensemble, increment by increment.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "host/case/result_fields.hpp"
#include "host/ensemble/reduction.hpp"
#include "io/increment_file.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

/// Fields that have no mean: a number that stands for a status or a packing, and the direction of an axis, where 89 and
/// -89 degrees are nearly the same.
constexpr std::array fields_without_mean{result_field("rve_status").name, result_field("packing").name,
                                         result_field("fabric_direction").name};

bool has_mean(const io::Field& field) {
  return std::none_of(fields_without_mean.begin(), fields_without_mean.end(),
                      [&](const char* name) { return field.name == name; });
}

/// A field of the first member, with the sums over the members so far. It is left out where a member lacks it.
struct FieldSums {
  io::Field like;  ///< without values
  std::vector<std::size_t> shape;
  BandSums sums;
  int members = 0;
};

/// The file of the increment in a member.
std::filesystem::path file_of(const MemberResults& member, const io::EnsembleIncrement& row) {
  return io::increment_path(member.folder, member.increments[place_of(member, row)].index);
}

std::vector<std::pair<io::FieldLocation, io::Bands>> bands_of_fields(std::span<const MemberResults> members,
                                                                     const BandRule& rule,
                                                                     const io::EnsembleIncrement& row) {
  std::vector<FieldSums> all;
  for (const MemberResults& member : members) {
    for (io::Field& field : io::read_fields(file_of(member, row))) {
      if (!has_mean(field)) continue;
      const std::vector<std::size_t> shape = io::shape_of(field);
      auto place = std::find_if(all.begin(), all.end(), [&](const FieldSums& known) {
        return known.like.location == field.location && known.like.name == field.name;
      });
      if (place == all.end()) {
        if (&member != &members.front()) continue;
        io::Field like{.name = field.name, .unit = field.unit, .location = field.location};
        place = all.insert(all.end(), {std::move(like), shape, BandSums(field.values.size())});
      }
      if (place->shape != shape) continue;
      place->sums.add(field.values);
      ++place->members;
    }
  }
  std::vector<std::pair<io::FieldLocation, io::Bands>> found;
  for (const FieldSums& field : all) {
    if (field.members != rule.members) continue;
    found.emplace_back(field.like.location, field.sums.bands(rule, field.like.name, field.like.unit, field.shape));
  }
  return found;
}

}  // namespace

bool reduce_fields(std::span<const MemberResults> members, const BandRule& rule,
                   const std::vector<io::EnsembleIncrement>& increments, const std::filesystem::path& folder,
                   const std::function<bool()>& before_each) {
  for (const io::EnsembleIncrement& row : increments) {
    if (!before_each()) return false;
    io::write_ensemble_fields(folder, row, rule.members, bands_of_fields(members, rule, row));
  }
  return true;
}

}  // namespace voussoir::host
