#include "sim/memory/attribution.h"

#include <algorithm>
#include <new>
#include <stdexcept>

namespace sim {

Attribution::Attribution(LineMap& map, std::uint32_t tile, std::size_t columns)
    : map_(map), tile_(tile), columns_(columns),
      by_kind_(static_cast<Traffic**>(std::calloc(map.kind_count(), sizeof(Traffic*)))) { // pages on demand
    if (columns > max_columns)
        throw std::invalid_argument("too many phases times kinds of work");
    if (by_kind_ == nullptr)
        throw std::bad_alloc();
    spill_ = make_cells(map.spill());
}

Traffic* Attribution::make_cells(LineKind kind) {
    made_.push_back(std::make_unique<Traffic[]>(columns_));
    return by_kind_[kind] = made_.back().get();
}

void Attribution::note_always(traces::Kind kind, std::uint64_t address, std::uint32_t bytes, std::uint64_t t,
                              std::size_t column, std::uint32_t stream, std::uint32_t site, traces::Part part,
                              std::uint32_t detail) {
    const LineMap::Line* line = map_.line(address);
    const LineKind what = line == nullptr ? map_.spill() : line->kind(tile_);
    tap_->note({t, address, stream, bytes, site, static_cast<std::uint16_t>(LineMap::structure_of(what)),
                static_cast<std::uint16_t>(column), kind, part, detail,
                owners_ != nullptr ? owners_->first_owner(column) : owner_of_column(column)});
}

std::vector<TrafficRow> Attribution::traffic(const std::vector<const Attribution*>& tiles) {
    std::vector<TrafficRow> out;
    const Attribution& first = *tiles.front();
    for (LineKind kind = 0; kind < first.map_.kind_count(); ++kind) {
        const auto has = [kind](const Attribution* tile) { return tile->by_kind_[kind] != nullptr; };
        if (std::none_of(tiles.begin(), tiles.end(), has))
            continue;
        for (std::size_t column = 0; column < first.columns_; ++column) {
            Traffic sum;
            for (const Attribution* tile : tiles)
                if (const Traffic* cells = tile->by_kind_[kind])
                    for (const TrafficColumn& c : traffic_columns)
                        sum.*c.count += cells[column].*c.count;
            if (!is_empty(sum))
                out.push_back({LineMap::structure_of(kind), LineMap::level_of(kind), column, sum});
        }
    }
    return out;
}

} // namespace sim
