// What the limit surface of one face depends on: its control points and a signature, both in an order that
// follows from the topology as seen from the face's first corner.
//
// The Catmull-Clark limit over a face is a function of the faces that share a point with it, of the sharpness
// of its own corner points, and of the sharpness of the edges that end at them (the outer edges and points of
// that ring of faces never enter a refined neighbourhood of the face). The signature writes down all of that
// completely, with points renumbered by first appearance, so two faces of equal signature have identical
// weights; the order only decides how often that happens.
#pragma once

#include "razor/surface/adjacency.h"

#include <cstdint>
#include <vector>

namespace razor {

/// Sharpness of every edge and point, 0 where there is no tag; of repeated tags the last counts, as in
/// OpenSubdiv.
struct Sharpness {
    std::vector<float> edge, point;
};
Sharpness gather_sharpness(const Mesh& mesh, const Adjacency& adjacency);

struct Neighbourhood {
    /// Interior quad among 3 x 3 quads, every corner of valence 4, nothing sharp: a bicubic B-spline patch.
    bool regular = false;
    /// Points. First the face's corners, then the rest of the ring, each once; if regular 16 entries, which
    /// may repeat: the corners, then for each corner the other three points of the face opposite to it,
    /// counter-clockwise.
    std::vector<int> controls;
    std::vector<std::int32_t> signature; // empty if regular
    bool folded = false, fading = false; // see FaceClass
};

class NeighbourhoodWalker {
public:
    /// Keeps references to both arguments.
    NeighbourhoodWalker(const Adjacency& adjacency, const Sharpness& sharpness);

    /// Refilled by every call. Stops early, with more than `control_cap` controls, where there are too many.
    const Neighbourhood& visit(int face, int control_cap);

private:
    /// Corners at the corner's point: this one, the fan counter-clockwise from it, then (if open) the fan
    /// clockwise from it, then whatever else meets there, by number.
    struct Fan {
        std::vector<int> corners;
        int counter_clockwise = 0, clockwise = 0;
        bool closed = false;
    };
    void gather_fan(int corner);
    bool gather_regular(int face);
    int local_number(int point);
    void append_sharpness(float sharpness);
    void append_fan(int corner);

    const Adjacency& adjacency_;
    const Sharpness& sharpness_;
    std::vector<int> stamp_, local_;         // of each point: last face that numbered it, and the number
    std::vector<std::int64_t> corner_stamp_; // of each corner: last fan that held it
    std::int64_t fan_number_ = 0;
    int face_ = -1;
    Fan fan_;
    Neighbourhood result_;
};

} // namespace razor
