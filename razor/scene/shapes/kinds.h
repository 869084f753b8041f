// Every shape's maker, one a source file beside this; the table of them all is in shapes.cpp.
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
