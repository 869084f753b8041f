#include "tests/benchmarks/embree/levels.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace razor::baseline {

double mean_edge(const Mesh& mesh) {
    double sum = 0;
    std::size_t first = 0;
    for (const int size : mesh.face_sizes) {
        const auto n = static_cast<std::size_t>(size);
        const auto point = [&](std::size_t k) {
            return mesh.points[static_cast<std::size_t>(mesh.face_vertices[first + k % n])];
        };
        for (std::size_t k = 0; k < n; ++k) {
            const glm::dvec3 edge = point(k + 1) - point(k);
            sum += glm::dot(edge, edge);
        }
        first += n;
    }
    return std::sqrt(sum / static_cast<double>(first));
}

std::vector<int> levels_of(const Scene& scene, const SceneGeometry& geometry, int finer) {
    std::vector<double> edges;
    for (const Mesh& mesh : scene.meshes)
        edges.push_back(mean_edge(mesh));
    std::vector<int> levels;
    for (const Instance& i : geometry.instances) {
        const double parts = edges[static_cast<std::size_t>(i.mesh)] / i.mesh_edge_length;
        const long level = parts > 0 ? std::lround(std::log2(parts)) + finer : 0;
        levels.push_back(static_cast<int>(std::clamp(level, 0L, static_cast<long>(finest_level))));
    }
    return levels;
}

std::vector<int> levels_by_deviation(const SceneGeometry& geometry,
                                     const std::vector<std::array<double, finest_level + 1>>& deviations,
                                     int finer) {
    std::vector<int> levels;
    for (const Instance& i : geometry.instances) {
        const auto& of = deviations[static_cast<std::size_t>(i.mesh)];
        const double allowed = std::ldexp(i.mesh_edge_length, -4 - 2 * finer);
        const auto* const first = std::find_if(of.begin(), of.end(), [&](double d) { return d <= allowed; });
        levels.push_back(std::min(static_cast<int>(first - of.begin()), finest_level));
    }
    return levels;
}

} // namespace razor::baseline
