#pragma once
/// The differences of two resolved cases (CaseFile::resolved), key by key.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace voussoir::io {

struct KeyDifference {
  std::string key;
  std::string ours, theirs;  ///< as a user would write the values; "nothing" where a case lacks the key
};

/// Whether two texts say the same value: equal texts, or one quantity in two units ("5 mm", "0.005 m"), to 12 digits.
[[nodiscard]] bool same_value(std::string_view a, std::string_view b);

/// The keys whose values differ, in the order of `ours`, then those that only `theirs` has; without the keys and tables
/// of `without`. Throws std::runtime_error where a text is no TOML.
[[nodiscard]] std::vector<KeyDifference> differences(const std::string& ours, const std::string& theirs,
                                                     std::span<const std::string> without = {});

/// "soil.modulus: this case has 300 MPa, the run was made with 3 GPa; soil.damping: ..." with at most three keys in
/// full, the rest by name. @param maker what was made with the other values, such as "the run"
[[nodiscard]] std::string describe(std::span<const KeyDifference> differences, std::string_view maker);

}  // namespace voussoir::io
