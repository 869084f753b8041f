#include "tests/benchmarks/embree/deviation.h"

#include "tests/benchmarks/embree/tessellation.h"

#include <algorithm>
#include <cmath>

namespace razor::baseline {
namespace {

/// Of vertices of odd row or column.
double mean_square(const GridMesh& grid, const std::vector<float>& positions) {
    double sum = 0, count = 0;
    for (const GridBlock& b : grid.blocks) {
        const int width = static_cast<int>(std::lround(std::sqrt(b.vertices)));
        const auto at = [&](int i, int j) {
            const float* p = positions.data() + 3 * (b.first_vertex + j * width + i);
            return glm::dvec3(p[0], p[1], p[2]);
        };
        for (int j = 0; j < width; ++j)
            for (int i = 0; i < width; ++i) {
                const int x = i % 2, y = j % 2;
                if (x + y == 0 || i + x >= width || j + y >= width)
                    continue;
                const glm::dvec3 off = at(i, j) - 0.5 * (at(i - x, j - y) + at(i + x, j + y));
                sum += off.x * off.x + off.y * off.y + off.z * off.z;
                ++count;
            }
    }
    return count > 0 ? sum / count : 0;
}

} // namespace

std::array<double, finest_level + 1> deviations(const Topology& topology, const PageMaker* pages,
                                                const std::vector<glm::dvec3>& points) {
    constexpr int measured = 5;
    std::array<double, finest_level + 1> result{};
    std::vector<float> xyz;
    for (const glm::dvec3& p : points)
        for (int k = 0; k < 3; ++k)
            xyz.push_back(static_cast<float>(p[k]));
    for (int level = 0; level <= finest_level; ++level) {
        const auto l = static_cast<std::size_t>(level);
        if (level >= measured) {
            result[l] = result[l - 1] / 4;
            continue;
        }
        const GridMesh next = make_grid_mesh(topology, pages, level + 1);
        std::vector<float> positions(static_cast<std::size_t>(3 * next.vertices)), normals(positions.size());
        tessellate({{&next, xyz.data(), positions.data(), normals.data()}}, choose_kernels("auto"), 1);
        result[l] = std::sqrt(mean_square(next, positions));
    }
    return result;
}

} // namespace razor::baseline
