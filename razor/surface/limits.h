// How large a cage's parts may be, and why.
#pragma once

namespace razor {

/// Corners of a face under subdivision. Building the limit surface of an n-gon costs time and memory as n^2
/// to n^3 (84 ms at 360 corners, 1.5 s at 1000).
inline constexpr int largest_subdivision_face = 256;

/// Corners of a face of a bilinear mesh: ear clipping costs n^2, and n^3 on polygons made for it.
inline constexpr int largest_bilinear_face = 1024;

/// Points that one face's limit surface may depend on: each page of weights has a row for every one.
inline constexpr int largest_control_count = 8192;

/// World units, as in scene files. Frames scale what they are given (razor/frame/unit.h), but what leaves
/// them, such as depth, must fit single precision (3e38).
inline constexpr double largest_coordinate = 1e30;

} // namespace razor
