// The levels of a mesh: who its vertices are, at which level each is born, and between which two parents it
// then lies. This is the definition, written for reading; nothing here is lazy or compact.
//
// - Level k aims at edges of e0 * 2^k. A curve (a cage edge, or a spoke of an n-gon) has an exponent N: 2^N
//   edges at level 0. A patch has a grid of 2^nu x 2^nv quads, nu and nv the larger of opposite sides' (a
//   sub-face's outer sides are half their curve: N - 1). At level k its quads are 2^d finest steps long both
//   ways, d = min(k, nu, nv). The diagonal runs (i,j)-(i+1,j+1) at every level.
// - A vertex is on a curve or inside a patch. Inside, its *index* is the largest level that still has it:
//   min(ctz i, ctz j). On a curve the curve decides, not the patch: at dyadic depth d the index is N - d.
//   Cage points and face centres have all levels. A negative index: no level has the vertex, but a patch's
//   grid is finer than its border there; it *hangs*, always, between its parents.
// - Parents, s = 2^index in finest steps: (odd, even) (i-s,j) and (i+s,j); (even, odd) (i,j-s) and (i,j+s);
//   (odd, odd) (i-s,j-s) and (i+s,j+s); on a curve, the neighbours at 2^ctz.
//
// At level k every vertex whose index is below k lies at the mean of its parents: so all levels are given on
// one vertex table, and a coarser one is the finest grid with its finer vertices pushed flat.
#pragma once

#include "razor/surface/topology.h"
#include "tests/reference/cages.h"

#include <glm/vec3.hpp>

#include <array>
#include <limits>
#include <memory>
#include <vector>

namespace razor::reference {

struct LevelOptions {
    double e0 = 0.1;            // target edge length of level 0
    int largest = 5;            // exponents are clamped to 0 ... largest
    std::vector<int> exponents; // of the cage edges, instead of their lengths'; empty: by length
};

inline constexpr int every_level = std::numeric_limits<int>::max();

struct Vertex {
    glm::dvec3 anchor{0};    // undisplaced: where footprints are taken
    int index = every_level; // the largest level that has it
    std::array<int, 2> parents{-1, -1};
};

struct Curve {
    int exponent = 0; // N
    int depth = 0;    // its vertices: 2^depth + 1, so many as its finest patch has
    std::vector<int> vertices;
};

struct Patch {
    int nu = 0, nv = 0;
    std::vector<int> grid; // (2^nu + 1) x (2^nv + 1), u fastest
    struct Side {
        int curve = -1;
        int begin = 0, step = 0; // finest step i along the side is vertex begin + i * step of the curve
    };
    std::array<Side, 4> sides; // 0: v = 0, 1: u = 1, 2: v = 1, 3: u = 0

    int vertex(int i, int j) const { return grid[static_cast<std::size_t>(j * ((1 << nu) + 1) + i)]; }
    int coarsest() const { return nu < nv ? nu : nv; }
};

class Levels {
public:
    Levels(const Case& scene, const LevelOptions& options);

    /// Parents stand before their children.
    const std::vector<Vertex>& vertices() const { return vertices_; }
    const std::vector<Curve>& curves() const { return curves_; }
    const std::vector<Patch>& patches() const { return patches_; }
    int vertex_count() const { return static_cast<int>(vertices_.size()); }
    /// Nothing is born at this level or above.
    int top() const { return top_; }
    double e0() const { return options_.e0; }
    bool displaced() const { return scene_.relief > 0; }

    /// v_k: where vertex v lies at level k if level k has it (displaced, and filtered for that level).
    glm::dvec3 position(int v, int k) const {
        return position_[static_cast<std::size_t>(k)][static_cast<std::size_t>(v)];
    }
    /// All vertices at level k, the finer ones flat between their parents.
    const std::vector<glm::dvec3>& discrete(int k) const { return discrete_[static_cast<std::size_t>(k)]; }

private:
    int edge_exponent(const CurveRecord& curve, int number) const;
    int curve_exponent(int curve) const;
    int patch_vertex(int patch, int i, int j) const;
    void make_curves(const class Positions& positions);
    void make_patches(const class Positions& positions);
    void make_positions();

    Case scene_;
    LevelOptions options_;
    Topology topology_;
    std::vector<Vertex> vertices_;
    std::vector<Curve> curves_;
    std::vector<Patch> patches_;
    int top_ = 0;
    std::vector<std::vector<glm::dvec3>> position_, discrete_;
};

} // namespace razor::reference
