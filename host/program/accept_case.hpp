#pragma once
/// The one way from a case file to a case that can be run, for `run`, `check`, `sweep` and `ensemble` alike: what `run`
/// would refuse, `check` refuses with the same line.

#include <filesystem>
#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "host/estimate/case_size.hpp"

namespace voussoir::host {

struct AcceptedCase {
  Case input;
  CaseSize size;
  std::string range = {};  ///< Foretold::line; its warnings are among the remarks of the input
};

/// Loads a case, reads the packing's file whole, makes the mesh to count its points, and estimates the memory. Throws
/// io::InputError where any of these shows that the case cannot be run.
[[nodiscard]] AcceptedCase accept_case(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// Refuses a ground of so many elements that its mesh alone has no room, before the mesh is made, which would take
/// minutes or hours. No mesh has fewer elements than half the squares of the size `mesh_size_far` that cover the
/// ground; the study's meshes have seven times as many as these squares, since they are finer at the opening.
void refuse_endless_mesh(const Case& input);

/// Throws io::InputError where a run on so many ranks takes more memory than this machine allows.
void refuse_too_large(const Case& input, const CaseSize& size, int ranks);

}  // namespace voussoir::host
