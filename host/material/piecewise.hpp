#pragma once
/// An evaluation in pieces. A long evaluation gives a caller no chance to stop it, and so the RVEs are advanced in
/// pieces of some tenths of a second where somebody asks for pauses. A piece has a group of RVEs at least, and where
/// this takes longer, the piece is watched. No bit depends on the pieces, since the answer of an RVE is the same in
/// every grouping (kernels/advance_rves.hpp).

#include <functional>
#include <span>
#include <vector>

#include "kernels/advance_rves.hpp"

namespace voussoir::host {

/// Called by the thread that has called `evaluate`, between two pieces and after the last one. What it throws ends the
/// evaluation.
using Pause = std::function<void()>;

/// Runs work in another thread, and looks meanwhile whether it is to end (kernels/state/stop_request.hpp). What ends
/// it is thrown.
using Watched = std::function<void(const std::function<void()>& work)>;

class Piecewise {
 public:
  /// Wanted time of a piece [s]. A request to stop then waits for half of it on average.
  static constexpr double piece_seconds = 0.3;

  /// @param seconds wanted time of a piece
  explicit Piecewise(double seconds = piece_seconds) : seconds_(seconds) {}

  /// @param watched runs pieces that take more than twice the wanted time; or empty
  void set_pause(Pause pause, Watched watched = {}) {
    pause_ = std::move(pause);
    watched_ = std::move(watched);
  }

  /// Advances as kernels::advance does, which without a pause is all.
  kernels::Work advance(kernels::RveBatch& batch, std::span<const kernels::StrainRequest> requests,
                        const kernels::EngineSettings& settings, std::span<kernels::RveReport> reports,
                        std::span<const int> rves);

 private:
  /// Time of a step of a grain in the last piece [s]. The first value is that of slow lanes, so that the first piece is
  /// rather too short.
  double rate_ = 2e-8;
  double seconds_;
  Pause pause_;
  Watched watched_;
};

}  // namespace voussoir::host
