#pragma once
/// Student's t distribution, by which a mean of few members gets its band.

namespace voussoir::host {

/// The t that |T| does not pass with the probability `confidence` (0 to 1), where T has Student's distribution with
/// this number of degrees of freedom, at least 1. Throws std::invalid_argument for other arguments.
[[nodiscard]] double student_two_sided(double confidence, int degrees);

}  // namespace voussoir::host
