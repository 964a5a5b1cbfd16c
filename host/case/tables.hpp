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

inline constexpr io::Key mesh{
    "mesh",
    "The elements of a scene, with named boundaries, regions and points: a file of Gmsh, or one of four shapes."};
inline constexpr io::Key region{
    "region",
    "A named part of the mesh and what it is made of: grains, or a linear elastic material. Each region of the mesh "
    "needs one such table."};
inline constexpr io::Key region_elastic{"elastic", "The linear elastic material of this region, in place of grains."};
inline constexpr io::Key region_soil{
    "soil",
    "Grains and contacts of this region, with the keys of `[soil]`. A key that the region does not give has the "
    "value of the file under `extends`, else that of `[soil]`."};
inline constexpr io::Key region_packing{
    "packing",
    "Packings of this region, with the keys of `[packing]`. A key that the region does not give has the value of the "
    "file under `extends`, else that "
    "of `[packing]`; seeds, pressure, folder and mirror images are those of `[packing]` in all regions."};
inline constexpr io::Key support{
    "support",
    "What holds boundaries or a point from the start. Where two supports name one axis of a node, the later one owns "
    "it; what nothing holds carries `packing.pressure`."};
inline constexpr io::Key stage{
    "stage",
    "A part of the loading, in which a parameter goes from 0 to 1. It changes what it names, and all else stays as it "
    "stands at its beginning."};
inline constexpr io::Key stage_move{
    "move", "A boundary or a point that is moved. The axes that the table names are held from then on."};
inline constexpr io::Key stage_press{
    "press",
    "A boundary whose load changes linearly from what loads it at the stage's beginning. It must not be held."};
inline constexpr io::Key stage_release{
    "release",
    "A boundary that is no longer held: the forces that held it at the stage's beginning are taken off step by step."};
inline constexpr io::Key stage_excavate{
    "excavate",
    "A region that is dug out: its elements are taken away, and the forces that they put on the rest are taken off "
    "step by step."};
inline constexpr io::Key record{
    "record",
    "What is written besides the fields and the columns of the boundaries: values at a point, along a line or, as "
    "means, of a region."};

}  // namespace voussoir::host::tables
