#include "razor/scene/models/hard_edges.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace razor {
namespace {

/// An edge of a face, from its lower point to the other.
struct Side {
    int low, high;
    glm::vec3 at_low, at_high; // normals of the face there
};

bool differ(const glm::vec3& a, const glm::vec3& b, double cosine) {
    const double lengths = double{glm::length(a)} * glm::length(b);
    return lengths > 0 && double{glm::dot(a, b)} < cosine * lengths;
}

} // namespace

std::vector<Crease> hard_edges(const std::vector<int>& triangles, const std::vector<glm::vec3>& normals,
                               double degrees) {
    std::vector<Crease> creases;
    if (degrees >= no_crease_angle || normals.empty())
        return creases;
    std::vector<Side> sides;
    sides.reserve(triangles.size());
    for (std::size_t c = 0; c < triangles.size(); ++c) {
        const std::size_t next = c % 3 == 2 ? c - 2 : c + 1;
        const bool turned = triangles[c] > triangles[next];
        const std::size_t low = turned ? next : c, high = turned ? c : next;
        sides.push_back({triangles[low], triangles[high], normals[low], normals[high]});
    }
    const auto edge = [](const Side& s) { return std::tuple(s.low, s.high); };
    std::stable_sort(sides.begin(), sides.end(),
                     [&](const Side& a, const Side& b) { return edge(a) < edge(b); });
    const double cosine = std::cos(glm::radians(degrees));
    for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
        bool hard = false;
        for (end = first + 1; end < sides.size() && edge(sides[end]) == edge(sides[first]); ++end)
            hard = hard || differ(sides[first].at_low, sides[end].at_low, cosine) ||
                   differ(sides[first].at_high, sides[end].at_high, cosine);
        if (hard)
            creases.push_back({sides[first].low, sides[first].high, infinite_sharpness});
    }
    return creases;
}

} // namespace razor
