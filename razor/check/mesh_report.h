// What is wrong with a cage, or would go wrong: counted, with the first place of each kind.
#pragma once

#include "razor/scene/scene.h"

#include <string>
#include <vector>

namespace razor::check {

/// So many, and the first: a face or a point (counted from 0), or the points of an edge.
struct Finding {
    int count = 0;
    int first = -1, second = -1;

    void add(int a, int b = -1) {
        if (count++ == 0) {
            first = a;
            second = b;
        }
    }
};

struct MeshReport {
    std::string name;
    int points = 0, faces = 0;
    int triangles = 0, quads = 0, larger = 0;
    int largest_valence = 0;     // faces at one point
    Finding open_edges;          // with one face
    Finding non_manifold_edges;  // with more than two
    Finding opposed_edges;       // whose two faces run the same way along it: opposite windings
    Finding pinched_points;      // whose faces form more than one fan
    Finding isolated_points;     // of no face
    Finding degenerate_faces;    // whose area is less than 1e-12 of the square of its longest edge
    Finding slivers;             // faces more than 10,000 times as long as wide, and not degenerate
    Finding repeated_faces;      // with the points of an earlier one, in whichever order
    Finding high_valence_points; // of more than 64 faces
    Finding semi_sharp; // creases and corners of sharpness above 0 and below 10; the points of the first
    Finding hole_faces;
    int bodies = 0; // parts that share no point
    int closed_bodies = 0;
    std::vector<int> body_of_face;
    std::vector<bool> body_is_closed; // two faces at every edge, and no hole

    bool closed() const { return closed_bodies == bodies; }
};

/// `mesh` must be valid (validate_mesh).
MeshReport examine(const Mesh& mesh);

/// The bodies of a mesh that are closed, with their tags; no faces if none is.
Mesh closed_part(const Mesh& mesh, const MeshReport& report);

/// The scene without what is open: no placement of it is left. No meshes if nothing is closed.
Scene closed_part(const Scene& scene, const std::vector<MeshReport>& reports);

} // namespace razor::check
