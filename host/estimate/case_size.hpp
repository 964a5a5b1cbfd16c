#pragma once
/// The size of a case and its cost, estimated before it is run.

#include <cstddef>
#include <string>
#include <vector>

namespace voussoir::host {

/// A region of a scene.
struct RegionSize {
  std::string name;
  std::size_t table = 0;   ///< number of its [[region]]
  double unit_weight = 0;  ///< [N/m3]
  std::size_t points = 0;  ///< Gauss points
  int variety = 0;         ///< packings at its points; 0 without grains
  int grains = 0;          ///< of a packing
};

struct CaseSize {
  std::vector<std::string> sentences = {};  ///< of a scene: mesh, boundaries, regions, stages, for `check`
  std::size_t points = 0;                   ///< Gauss points of the largest mesh
  std::size_t column_points = 0;            ///< Gauss points of the column
  std::size_t increments = 0;               ///< planned, all stages
  double grains = 0;                        ///< grains of all RVEs of the largest mesh; 0 without grains
  double particle_steps = 0;  ///< estimate for the whole run [grains x steps] without the making of packings; 0 without
                              ///< grains
  std::size_t tests = 0;      ///< tests of packings, for kinds without a mesh
  std::size_t packings = 0;   ///< packings to be made or found
  double memory = 0;          ///< estimate for the first process [bytes]
  double result_file = 0;     ///< estimate [bytes]; 0 without a mesh
  double checkpoint = 0;      ///< estimate for one checkpoint, of which two are kept [bytes]
  std::size_t nodes = 0;      ///< of a scene's mesh; 0: not counted
  double height = 0;          ///< of a scene's mesh [m]
  std::vector<RegionSize> regions = {};  ///< of a scene
  double lanes_share = 1;                ///< share of the lanes that hold an RVE, see share_of_lanes [-]
};

}  // namespace voussoir::host
