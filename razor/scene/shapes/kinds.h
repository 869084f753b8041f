// Every shape's maker, one a source file beside this; the table of them all is in shapes.cpp.
//
// Texture coordinates (u, v): of a plane (0, 0) to (1, 1) from its corner at -x and z to the one at x and -z;
// of a box a net, each side a unit square; of what is turned u around, from z to x, v along the profile, a
// foot's disk in the unit square; of a knot u along, v around; of a dish as seen from above; of a sponge each
// side's by the two axes that it lies along, 0 to 1. Gears, urchins and canopies have none.
#pragma once

#include "razor/scene/shapes/shapes.h"

namespace razor {

/// A flat rectangle in y = 0 about the origin, facing up.
ShapeKind plane_kind();
/// A box about the origin, all twelve edges equally sharp: from a blob (0) over a rounded box to a plain one
/// (10).
ShapeKind box_kind();
/// A chess pawn standing on y = 0, two units high: a turned profile, its foot one n-gon, its top a fan of
/// triangles.
ShapeKind pawn_kind();
/// A footed bowl with an inside, standing on y = 0: a turned profile, its foot one n-gon.
ShapeKind bowl_kind();
/// A toothed wheel about the y axis with a bore, its rims semi-sharp; tips at radius 1.
ShapeKind gear_kind();
/// A band of rectangular section along a trefoil knot about the y axis, its four edges semi-sharp.
ShapeKind knot_kind();
ShapeKind limb_kind();
/// A dodecahedron with an arm pulled out of every face, each ending in a pentagon.
ShapeKind urchin_kind();
/// A cube pierced through all faces (the first Menger sponge): extraordinary points of valence 3, 5 and 6.
/// Edge length 2.
ShapeKind sponge_kind();
/// An open sheet y = rise r^2 + wave r^3 cos(petals angle) over the unit disk, an n-gon in its middle: a wavy
/// dish.
ShapeKind dish_kind();
/// A star-shaped roof of saddle quads, for the bilinear scheme: none of its faces is planar.
ShapeKind canopy_kind();

} // namespace razor
