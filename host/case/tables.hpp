#pragma once
/// The tables of a case file and the sentences that explain them. The keys in them have theirs in the reader of the
/// table.

#include "io/key.hpp"

namespace voussoir::host::tables {

inline constexpr io::Key soil{"soil",
                              "Grains and their contacts (docs/explanation/contact_law.md). The defaults are the "
                              "coarse sand of Table 1 of the paper by Xie and others."};
inline constexpr io::Key packing{"packing",
                                 "How the packings of grains in the representative volume elements are made, or where "
                                 "they come from (docs/explanation/packings.md)."};
inline constexpr io::Key engine{"engine",
                                "Speed and accuracy with which the grains are moved. docs/validation/trade.md measures "
                                "what each key costs and buys, and docs/how-to/choose_accuracy.md helps to choose."};
inline constexpr io::Key elastic{"elastic",
                                 "The linear elastic material that `material = \"linear_elastic\"` puts in place of "
                                 "grains, to verify the finite elements without them."};
inline constexpr io::Key newton{
    "newton",
    "How equilibrium of the mesh is found by Newton iteration, and when it counts as found "
    "(docs/explanation/one_increment.md). An increment that finds none is relaxed, which means that the grains move on "
    "in small substeps under the held load until they are at rest, or it is cut into smaller steps."};
inline constexpr io::Key output{"output", "What is written, and how often."};
inline constexpr io::Key ground{
    "ground",
    "Half of the ground, since the vertical axis through the tunnel is one of symmetry (docs/explanation/tunnel.md)."};
inline constexpr io::Key column{"column",
                                "The oedometric column that measures the coefficient of earth pressure at rest K0 "
                                "against the vertical stress. A tunnel takes its horizontal stress from it."};
inline constexpr io::Key gravity{
    "gravity", "Increments of load in which the weight of the ground is put on the column and on the ground."};
inline constexpr io::Key volume_loss{
    "volume_loss", "The shrinking of the opening, which stands for the ground that is lost while a tunnel is driven."};
inline constexpr io::Key biaxial_bvp{
    "biaxial_bvp",
    "A drained biaxial test on a rectangle of elements: the top is moved down, and the sides bear a pressure."};
inline constexpr io::Key biaxial{
    "biaxial",
    "Drained biaxial tests on single packings: the vertical axis is compressed, and the horizontal stress is held."};
inline constexpr io::Key probe{
    "probe", "Small strains that are put on one packing, each from the same state at the end of a strain path."};
inline constexpr io::Key calibrate{
    "calibrate",
    "Search of the rolling resistance and the thickness with which the tests of `[biaxial]` show a wanted strength. "
    "Classes of grains keep their ratios to `[soil]`."};

}  // namespace voussoir::host::tables
