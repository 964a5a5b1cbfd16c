#pragma once
/// Units of case files. The only place of the program where a unit is converted: everything behind it is SI.

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace voussoir::io {

enum class Dimension {
  none,         ///< dimensionless: a plain number, or "%"
  length,       ///< [m]
  pressure,     ///< stress, modulus [Pa]
  unit_weight,  ///< [N/m3]
  density,      ///< [kg/m3]
  angle         ///< [rad]
};

/// One unit a user may write; value in SI = value as written * factor.
struct Unit {
  std::string_view symbol;
  Dimension dimension;
  double factor;
  /// False for a unit that is read only. format_quantity chooses the shortest text, so a further unit would change how
  /// resolved cases are written, and with them the fingerprints of results that exist.
  bool written = true;
};

/// Text that is no quantity of the wanted dimension; the message is a sentence without a place in a file.
struct UnitError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// All units that a user may write; the SI unit comes first in each dimension.
[[nodiscard]] std::span<const Unit> units();

/// "length", "pressure", ... as used in messages.
[[nodiscard]] std::string_view dimension_name(Dimension dimension);

/// Symbol of the SI unit, "-" for dimensionless.
[[nodiscard]] std::string_view si_unit(Dimension dimension);

/// "5 mm" -> 0.005 for Dimension::length. Throws UnitError on an unknown unit, another dimension, a missing unit, text
/// that is no number, or a value that is not finite.
[[nodiscard]] double parse_quantity(std::string_view text, Dimension expected);

/// An SI value as a user would write it ("5 mm"); parse_quantity gives back the same bits.
[[nodiscard]] std::string format_quantity(double in_si, Dimension dimension);

}  // namespace voussoir::io
