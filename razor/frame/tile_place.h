// Where screen tiles are.
#pragma once

#include "razor/frame/layout.h"
#include "razor/scene/scene.h"

#include <algorithm>
#include <cstddef>

namespace razor {

/// A screen tile by its column and row in the whole picture, counted in tiles.
struct TilePlace {
    int column = 0, row = 0;

    bool operator==(const TilePlace&) const = default;
};

/// Calls visit(number) for each of the tile's pixels in a film of that part of the picture.
template <class Visit> void each_pixel(const TilePlace& tile, const Crop& part, Visit visit) {
    const int x0 = std::max(tile.column * tile_side - part.x, 0);
    const int y0 = std::max(tile.row * tile_side - part.y, 0);
    const int x1 = std::min((tile.column + 1) * tile_side - part.x, part.width);
    const int y1 = std::min((tile.row + 1) * tile_side - part.y, part.height);
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
            visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width) +
                  static_cast<std::size_t>(x));
}

} // namespace razor
