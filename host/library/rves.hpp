#pragma once
/// What a foreign program calls: threads, packings, and RVEs that answer displacement gradients with stresses and
/// tangents. docs/reference/public_interface.md states this interface with its units, errors and promise of stability;
/// it consists of this header, fem/material_batch.hpp, io/packing_file.hpp and io/input_error.hpp.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem/material_batch.hpp"

namespace voussoir::library {

// The libraries are compiled with Eigen's explicit vectorisation switched off. A program that is compiled with it may
// align matrices otherwise, and they could not cross the interface.
static_assert(alignof(fem::Gradient) == alignof(double),
              "compile with EIGEN_DONT_VECTORIZE, as the CMake target voussoir::voussoir does");

/// Receives the lines that the program would write into its log; it may be empty.
using Note = std::function<void(const std::string&)>;

/// The threads of the engine, from the constructor to the destructor. One session must live while packings are made or
/// RVEs exist. A second session after the first one has ended is not possible, because Kokkos starts only once in a
/// process. Where the foreign program has started Kokkos itself, the session takes the threads of that start.
class Session {
 public:
  /// @param threads wanted number; 0: as the program chooses (KOKKOS_NUM_THREADS, OMP_NUM_THREADS, or one for each
  /// core)
  explicit Session(int threads = 0);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] int threads() const;

 private:
  struct Kokkos;
  std::unique_ptr<Kokkos> kokkos_;
};

/// Makes the packings of a case, or finds them where they were made before: those of `packing.seeds`, or of
/// `packing.candidates` seeds from `packing.seed` on. Returns the files of those that came to rest, in the folder
/// `packing.folder`, in the order of the seeds. io::load_packing reads such a file.
/// @param settings as `--set` of the program, such as "packing.grains=300"; they override the case file
/// @throws io::InputError where case or settings have a fault, std::runtime_error where no packing comes to rest or a
/// file cannot be written
[[nodiscard]] std::vector<std::filesystem::path> make_packings(const std::filesystem::path& case_file,
                                                               const std::vector<std::string>& settings = {},
                                                               const Note& note = {});

/// `n` RVEs as a case describes them by its tables [soil], [packing] and [engine], and by `newton.tangent` where the
/// kind has this key. Their packings are made, or found, or read from `packing.file`; `packing.variety` of them are
/// spread over the RVEs. The RVEs begin at rest under the pressure of their packings, which is the committed stress.
/// `fields()` has what `output.microstructure` asks for. `packing.mirrored` is not obeyed: no RVE answers as its mirror
/// image.
/// @throws as make_packings
[[nodiscard]] std::unique_ptr<fem::MaterialBatch> make_rves(const std::filesystem::path& case_file, std::size_t n,
                                                            const std::vector<std::string>& settings = {},
                                                            const Note& note = {});

}  // namespace voussoir::library
