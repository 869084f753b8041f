// What memory saw for each screen tile of the picture that was rendered while a trace was recorded.
#pragma once

#include "analysis/images/linear_image.h"
#include "analysis/traces/coherent_caches.h"
#include "traces/description.h"

#include <array>
#include <cstdint>
#include <vector>

namespace analysis {

/// Of a tile: touches of lines, bytes touched (each time), misses of caches of one shape, and what of these
/// misses were of lines that the cache never had.
struct TileCount {
    std::uint64_t references = 0, bytes = 0, misses = 0, first = 0;
    TileCount& operator+=(const TileCount& o) {
        references += o.references;
        bytes += o.bytes;
        misses += o.misses;
        first += o.first;
        return *this;
    }
};

/// A figure of it; the ratio is of misses to references, not a number where there are none.
enum class TileFigure { references, bytes, misses, first, ratio };
inline constexpr std::array<const char*, 5> tile_figure_names = {"references", "bytes", "misses",
                                                                 "first touches", "miss ratio"};

class TileCounts {
public:
    /// `tiles`: those of the picture.
    TileCounts(CacheShape shape, std::uint32_t tiles)
        : caches_(shape, Watch{std::vector<TileCount>(tiles + 1)}) {}

    /// By a cache, of numbers from 0 on.
    void touch(const Touch& t, std::uint32_t cache) {
        TileCount& count = caches_.observer().counts[t.tile];
        ++count.references;
        count.bytes += t.high - t.low + 1;
        caches_.touch(t, cache);
    }
    /// By the tile's number; the first is what was for none.
    const std::vector<TileCount>& counts() const { return caches_.observer().counts; }
    /// Of each pixel that of its tile, rows from the top.
    std::vector<double> pixels(TileFigure figure, const traces::Picture& picture) const;

private:
    struct Watch {
        void filled(const HeldLine& /*line*/, const Copy& copy, const Touch& t) {
            ++counts[t.tile].misses;
            counts[t.tile].first += copy.fresh ? 1 : 0;
        }
        void used(const Copy&, std::uint64_t) {}
        void left(const HeldLine&, const Copy&) {}
        std::vector<TileCount> counts;
    };
    CoherentCaches<Watch> caches_;
};

} // namespace analysis
