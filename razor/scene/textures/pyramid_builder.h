// Makes the pyramid of a picture that comes row by row, so that no picture is ever whole in floats.
//
// A level of w x h texels has ceil(w/2) x ceil(h/2) above it. Each texel there is the mean of the area that
// it covers, texels below weighted by how much of them lies in it: where w is odd, a texel above covers 2 -
// 1/ceil(w/2) below, and parts of three (Guthe and Heckbert, "Non-power-of-two mipmapping"). Means are of
// linear values before they are packed. Colour and opacity have means of their own.
#pragma once

#include "razor/scene/texture.h"

#include <glm/vec4.hpp>

#include <span>

namespace razor {

class PyramidBuilder {
public:
    /// Sides from 1 to 32768.
    PyramidBuilder(int width, int height, Texels kind = Texels::colours);

    /// The next row, from the top: linear red, green, blue, and opacity in [0, 1]. Of heights: red, finite.
    void add_row(std::span<const glm::vec4> row);

    /// After the last row.
    TexturePyramid finish();

private:
    struct Building {
        TextureLevel level;
        int rows = 0; // that it has
        // Of the level above:
        std::vector<glm::vec4> filtered; // the last row, as wide as above
        std::vector<glm::vec4> sum;      // the row under way
        int row_above = 0;
    };
    void add(std::size_t level, std::span<const glm::vec4> row);
    void store(Building& building, std::span<const glm::vec4> row);

    std::vector<Building> levels_;
    bool opaque_ = true;
    Texels kind_;
    float least_ = 0, most_ = 0;
};

} // namespace razor
