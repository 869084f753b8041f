#include "traces/tile_runs.h"

#include "traces/recent_tiles.h"
#include "traces/varint.h"

namespace traces {

// How many bytes lengths take; the lengths of runs, of each segment by itself; for each run the place of its
// tile among the segment's last ones, or 0 and how far it is from the last one. (Apart, as each repeats
// itself.)
void put_tiles(const Block& block, std::string& out) {
    if (block.tiles.empty())
        return;
    std::string lengths, tiles;
    for (const Segment& s : block.segments) {
        RecentTiles recent;
        for (std::size_t i = s.begin, next = i; i < s.end; i = next) {
            const std::uint32_t tile = block.tiles[i];
            while (next < s.end && block.tiles[next] == tile)
                ++next;
            append_varint(lengths, next - i);
            const std::uint32_t place = recent.place_of(tile);
            append_varint(tiles, place);
            if (place == 0)
                append_varint(tiles, zigzag(std::uint64_t{tile} - recent.last()));
            recent.use(tile, place);
        }
    }
    append_varint(out, lengths.size());
    out += lengths;
    out += tiles;
}

const char* get_tiles(const std::string& column, std::uint32_t most, Block& block) {
    block.tiles.clear();
    if (column.empty())
        return nullptr;
    const char* const end = column.data() + column.size();
    VarintReader size(column.data(), end);
    const std::uint64_t of_lengths = size.next();
    if (size.bad() || of_lengths > static_cast<std::uint64_t>(end - size.at()))
        return "a block's runs of tiles are longer than themselves";
    const char* const middle = size.at() + of_lengths;
    VarintReader lengths(size.at(), middle), tiles(middle, end);
    block.tiles.reserve(block.segments.back().end);
    for (const Segment& s : block.segments) {
        RecentTiles recent;
        while (block.tiles.size() < s.end) {
            const std::uint64_t length = lengths.next(), place = tiles.next();
            if (length == 0 || length > s.end - block.tiles.size() || place > RecentTiles::most)
                return "a block's runs of tiles do not fit its streams";
            const std::uint64_t tile = place != 0 ? recent.at(static_cast<std::uint32_t>(place))
                                                  : recent.last() + unzigzag(tiles.next());
            if (tile > most)
                return "a reference is for a tile that the picture does not have";
            block.tiles.insert(block.tiles.end(), length, static_cast<std::uint32_t>(tile));
            recent.use(static_cast<std::uint32_t>(tile), static_cast<std::uint32_t>(place));
        }
    }
    return lengths.bad() || !lengths.ended() || tiles.bad() || !tiles.ended()
               ? "a block's runs of tiles do not fit its count"
               : nullptr;
}

} // namespace traces
