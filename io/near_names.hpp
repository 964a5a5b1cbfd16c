#pragma once
/// Known names that a user may have meant by an unknown one.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace voussoir::io {

/// How far a name may be from a known one that it is taken for, as a number of letters (edit_distance).
[[nodiscard]] std::size_t most_distance(std::string_view name);

/// The number of letters to insert, remove or replace that makes one name of the other (the Levenshtein distance). Its
/// time goes as the product of both lengths.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The last of the names that are nearest to `wanted`, by letters or because one continues the other ("friction" and
/// "friction_angle"); where both lead equally near, letters decide. Empty where all are farther than most_distance.
[[nodiscard]] std::string nearest_name(const std::vector<std::string>& names, std::string_view wanted);

/// The known keys, "soil.thickness", that are meant by an unknown name perhaps, the nearest first and five at the most:
/// those near to this name as above, or, for a name without a table, those whose last part nearly is this name. None
/// for names of more than 100 bytes.
[[nodiscard]] std::vector<std::string> near_names(const std::string& wanted, const std::vector<std::string>& known);

}  // namespace voussoir::io
