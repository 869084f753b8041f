// Rays against schemes, counted.
#pragma once

#include "tests/reference/schemes.h"

#include <map>
#include <string>
#include <vector>

namespace razor::reference {

struct Setting {
    std::string scene = "sphere";
    bool random_exponents = false; // per edge, 0 ... largest; else by length
    int largest = 4;
    double e0 = 0.1;
    double w0 = 1; // in e0
    double growth = 0.1;
    double cap = std::numeric_limits<double>::infinity();
    double part = 0.25;          // of an octave that morphs
    int side = 1;                // quads along a block
    int origins = 8, rays = 200; // a quarter of the origins lies outside; rays of each origin
    bool aimed = true;           // half of the rays at vertices and edges, exactly; else all at random
    unsigned seed = 1;
};

struct Counts {
    long rays = 0;
    long escapes = 0; // from inside, and nothing hit
    long uneven = 0;  // an odd number of crossings from outside, an even one from inside
    long astray = 0;  // nearest hit more than four target edges from that of `recursive`
    long other = 0;   // nearest hit neither in the same triangle nor at the same distance (to 1e-9)
    long open = 0;    // edges with an odd number of triangles

    void add(const Counts& c);
};

struct BlockCounts {
    long origins = 0, visited = 0, drawn = 0, morphing = 0;
    long levels = 0, deepest = 0; // that a drawn block's vertices are blended from, above its own
    long triangles = 0, finest = 0;

    void add(const BlockCounts& c);
};

struct Result {
    std::map<std::string, Counts> schemes;
    BlockCounts blocks; // of `walk`
};

/// Deterministic in the setting.
Result run(const Setting& setting, const std::vector<std::string>& schemes);

Levels make_levels(const Setting& setting);
View make_view(const Setting& setting, const glm::dvec3& origin);
/// Inside at every level.
std::vector<glm::dvec3> inner_points(const Levels& levels, const PointMaker& make, int count,
                                     std::mt19937& random);
/// A random direction, or one to a vertex or edge of the soup.
glm::dvec3 aim(const glm::dvec3& origin, const Soup& soup, std::mt19937& random);

} // namespace razor::reference
