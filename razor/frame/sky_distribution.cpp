#include "razor/frame/sky_distribution.h"

#include "razor/scene/textures/shared_exponent.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace razor {
namespace {

using std::numbers::pi;

const TextureLevel& sampled_level(const TexturePyramid& map) {
    return *std::find_if(map.levels.begin(), map.levels.end() - 1, [](const TextureLevel& level) {
        return level.width <= most_sky_columns && level.height <= most_sky_rows;
    });
}

double brightness(const TextureLevel& level, int x, int y) {
    const int tiles = (level.width + texel_tile - 1) / texel_tile;
    const int word = texel_tile * texel_tile * (y / texel_tile * tiles + x / texel_tile) +
                     texel_tile * (y % texel_tile) + x % texel_tile;
    const glm::vec3 c = unpack_shared_exponent(level.texels[static_cast<std::size_t>(word)]);
    return (double{c.x} + c.y + c.z) / 3;
}

/// Means over cells of what is interpolated: a cell has 3/4 of its own texel, along each axis, and 1/8 of
/// each beside it.
std::vector<double> interpolated(const TextureLevel& level) {
    const int w = level.width, h = level.height;
    const auto at = [w](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
    };
    std::vector<double> along(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)), both(along.size());
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            along[at(x, y)] =
                0.75 * brightness(level, x, y) +
                0.125 * (brightness(level, (x + w - 1) % w, y) + brightness(level, (x + 1) % w, y));
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            both[at(x, y)] = 0.75 * along[at(x, y)] + 0.125 * (along[at(x, std::max(y - 1, 0))] +
                                                               along[at(x, std::min(y + 1, h - 1))]);
    return both;
}

/// Sums before each of so many chances, and 1.
template <class Chance> void append_sums(std::vector<float>& sums, int count, const Chance& chance) {
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        sums.push_back(static_cast<float>(std::min(sum, 1.0)));
        sum += chance(i);
    }
    sums.push_back(1);
}

} // namespace

SkyDistribution sky_distribution(const TexturePyramid& map) {
    const TextureLevel& level = sampled_level(map);
    const int w = level.width, h = level.height;
    const std::vector<double> shown = interpolated(level);
    std::vector<double> of_row(static_cast<std::size_t>(h)); // means
    SkyDistribution d{
        .columns = w, .rows = h, .heights = {}, .row_sums = {}, .cell_sums = {}, .row_density = {}};
    double all = 0; // of the sphere's mean
    for (int y = 0; y <= h; ++y)
        d.heights.push_back(static_cast<float>(std::cos(pi * y / h)));
    const auto share = [&](int y) { // of the sphere
        return (double{d.heights[static_cast<std::size_t>(y)]} - d.heights[static_cast<std::size_t>(y) + 1]) /
               2;
    };
    for (int y = 0; y < h; ++y) {
        const double* row = shown.data() + static_cast<std::ptrdiff_t>(y) * w;
        double sum = 0;
        for (int x = 0; x < w; ++x)
            sum += row[x];
        of_row[static_cast<std::size_t>(y)] = sum / w;
        all += sum / w * share(y);
    }
    if (!(all > 0))
        return {};
    const auto row_chance = [&](int y) {
        return share(y) * (even_share + (1 - even_share) * of_row[static_cast<std::size_t>(y)] / all);
    };
    append_sums(d.row_sums, h, row_chance);
    for (int y = 0; y < h; ++y) {
        const double* row = shown.data() + static_cast<std::ptrdiff_t>(y) * w;
        const double mean = even_share + (1 - even_share) * of_row[static_cast<std::size_t>(y)] / all;
        append_sums(d.cell_sums, w,
                    [&](int x) { return (even_share + (1 - even_share) * row[x] / all) / mean / w; });
        const double chance =
            double{d.row_sums[static_cast<std::size_t>(y) + 1]} - d.row_sums[static_cast<std::size_t>(y)];
        d.row_density.push_back(static_cast<float>(chance / (4 * pi * share(y) / w)));
    }
    return d;
}

} // namespace razor
