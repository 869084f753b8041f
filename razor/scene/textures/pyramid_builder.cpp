#include "razor/scene/textures/pyramid_builder.h"

#include "razor/scene/textures/shared_exponent.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace razor {
namespace {

constexpr int half(int side) {
    return (side + 1) / 2;
}

/// How much of texel `below`, of `side`, lies in texel `above`, of half(side): in 1/half(side).
std::int64_t overlap(int below, int above, int side) {
    const std::int64_t b = below, a = above, s = side, h = half(side);
    return std::max<std::int64_t>(0, std::min((b + 1) * h, (a + 1) * s) - std::max(b * h, a * s));
}

/// The same as a part of what texel `above` covers.
float weight(int below, int above, int side) {
    return static_cast<float>(overlap(below, above, side)) / static_cast<float>(side);
}

/// The first texel below that texel `above` covers.
int first_covered(int above, int side) {
    return static_cast<int>(std::int64_t{above} * side / half(side));
}

std::size_t tiles(int side) {
    return static_cast<std::size_t>((side + texel_tile - 1) / texel_tile);
}

void filter_row(std::span<const glm::vec4> row, std::span<glm::vec4> above) {
    const auto side = static_cast<int>(row.size());
    if (side == 1 || side % 2 == 0) {
        const std::size_t step = side == 1 ? 0 : 1;
        for (std::size_t a = 0; a < above.size(); ++a)
            above[a] = 0.5F * (row[2 * a] + row[2 * a + step]);
        return;
    }
    for (int a = 0; a < half(side); ++a) {
        glm::vec4 sum(0);
        const int first = first_covered(a, side);
        for (int b = first; b < std::min(first + 3, side); ++b)
            sum += weight(b, a, side) * row[static_cast<std::size_t>(b)];
        above[static_cast<std::size_t>(a)] = sum;
    }
}

} // namespace

PyramidBuilder::PyramidBuilder(int width, int height, Texels kind) : kind_(kind) {
    for (;;) {
        Building building;
        TextureLevel& level = building.level;
        level.width = width;
        level.height = height;
        // Touched row by row: a damaged picture costs what there is of it.
        level.texels.reserve(texel_tile * texel_tile * tiles(width) * tiles(height));
        const bool last = width == 1 && height == 1;
        width = half(width);
        height = half(height);
        if (!last) {
            building.filtered.resize(static_cast<std::size_t>(width));
            building.sum.resize(static_cast<std::size_t>(width), glm::vec4(0));
        }
        levels_.push_back(std::move(building));
        if (last)
            return;
    }
}

void PyramidBuilder::add_row(std::span<const glm::vec4> row) {
    if (kind_ == Texels::heights) {
        if (levels_.front().rows == 0)
            least_ = most_ = row.front().x;
        for (const glm::vec4& texel : row) {
            least_ = std::min(least_, texel.x);
            most_ = std::max(most_, texel.x);
        }
        add(0, row);
        return;
    }
    if (opaque_ && std::any_of(row.begin(), row.end(), [](const glm::vec4& t) { return t.w != 1; })) {
        opaque_ = false;
        const std::uint32_t one = pack_shared_exponent(glm::vec3(1));
        for (Building& building : levels_) {
            building.level.opacity.reserve(building.level.texels.capacity());
            building.level.opacity.resize(building.level.texels.size(), one);
        }
    }
    add(0, row);
}

void PyramidBuilder::add(std::size_t number, std::span<const glm::vec4> row) {
    Building& building = levels_[number];
    store(building, row);
    const int side = building.level.height, y = building.rows++;
    if (number + 1 == levels_.size())
        return;
    filter_row(row, building.filtered);
    for (int& above = building.row_above; above < half(side); ++above) {
        const float w = weight(y, above, side);
        if (w == 0)
            return;
        for (std::size_t x = 0; x < building.sum.size(); ++x)
            building.sum[x] += w * building.filtered[x];
        if (weight(y + 1, above, side) > 0 && y + 1 < side)
            return;
        add(number + 1, building.sum);
        std::fill(building.sum.begin(), building.sum.end(), glm::vec4(0));
    }
}

/// With what lies in tiles beyond the picture's edges.
void PyramidBuilder::store(Building& building, std::span<const glm::vec4> row) {
    TextureLevel& level = building.level;
    const auto y = static_cast<std::size_t>(building.rows);
    const bool last = building.rows + 1 == level.height;
    const std::size_t columns = tiles(level.width), end = last ? texel_tile * tiles(level.height) : y + 1;
    if (y % texel_tile == 0) {
        level.texels.resize(level.texels.size() + texel_tile * texel_tile * columns);
        if (!opaque_)
            level.opacity.resize(level.texels.size());
    }
    const auto put = [&](std::vector<std::uint32_t>& words, std::size_t x, std::uint32_t word) {
        for (std::size_t at = y; at < end; ++at)
            words[16 * (at / 4 * columns + x / 4) + 4 * (at % 4) + x % 4] = word;
    };
    for (std::size_t x = 0; x < texel_tile * columns; ++x) {
        const glm::vec4& texel = row[std::min(x, row.size() - 1)];
        put(level.texels, x,
            kind_ == Texels::heights ? std::bit_cast<std::uint32_t>(texel.x)
                                     : pack_shared_exponent(glm::vec3(texel)));
        if (!opaque_)
            put(level.opacity, x, pack_shared_exponent(glm::vec3(texel.w)));
    }
}

TexturePyramid PyramidBuilder::finish() {
    TexturePyramid pyramid;
    pyramid.kind = kind_;
    pyramid.least = least_;
    pyramid.most = most_;
    for (Building& building : levels_)
        pyramid.levels.push_back(std::move(building.level));
    return pyramid;
}

} // namespace razor
