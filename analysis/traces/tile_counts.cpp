#include "analysis/traces/tile_counts.h"

#include <limits>

namespace analysis {
namespace {

double figure_of(const TileCount& c, TileFigure figure) {
    switch (figure) {
    case TileFigure::references:
        return static_cast<double>(c.references);
    case TileFigure::bytes:
        return static_cast<double>(c.bytes);
    case TileFigure::misses:
        return static_cast<double>(c.misses);
    case TileFigure::first:
        return static_cast<double>(c.first);
    case TileFigure::ratio:
        break;
    }
    return c.references == 0 ? std::numeric_limits<double>::quiet_NaN()
                             : static_cast<double>(c.misses) / static_cast<double>(c.references);
}

} // namespace

std::vector<double> TileCounts::pixels(TileFigure figure, const traces::Picture& picture) const {
    std::vector<double> out;
    out.reserve(std::size_t{picture.width} * picture.height);
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x)
            out.push_back(figure_of(counts()[picture.tile_of(x, y)], figure));
    return out;
}

} // namespace analysis
