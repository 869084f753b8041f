#include "analysis/traces/touches.h"

#include <fmt/format.h>

#include <algorithm>

namespace analysis {

using traces::Class;
using traces::Kind;

Touches::Touches(unsigned line_shift, Kinds kinds, Grouping grouping)
    : shift_(line_shift), kinds_(kinds), grouping_(std::move(grouping)) {
    std::erase(grouping_.by, By::all);
    for (const By by : grouping_.by) {
        static_key_ = static_key_ && by != By::thread && by != By::window && by != By::tile;
        by_window_ = by_window_ || by == By::window;
    }
}

std::uint32_t Touches::group_of(Key key, std::uint32_t stream, std::uint64_t window, std::uint32_t tile) {
    for (std::size_t i = 0; i < key.size(); ++i)
        if (grouping_.by[i] == By::thread)
            key[i] = stream;
        else if (grouping_.by[i] == By::window)
            key[i] = window;
        else if (grouping_.by[i] == By::tile)
            key[i] = tile;
    const auto [found, fresh] = groups_.try_emplace(std::move(key), static_cast<std::uint32_t>(keys_.size()));
    if (fresh)
        keys_.push_back(found->first);
    return found->second;
}

void Touches::classify(const traces::Block& block) {
    counted_.assign(block.table.size(), {});
    combined_.clear();
    std::map<Key, std::uint32_t> numbers; // in combined_
    for (std::size_t i = 0; i < counted_.size(); ++i) {
        const Class& c = block.table[i];
        Counted& counted = counted_[i];
        counted.counts = kinds_[static_cast<std::size_t>(c.kind)];
        if (!counted.counts)
            continue;
        counted.writes = c.kind == Kind::write || c.kind == Kind::modify || c.kind == Kind::write_back ||
                         c.kind == Kind::write_through;
        counted.size = c.size;
        counted.more = std::max(c.size, 1U) - 1;
        Key key;
        for (const By by : grouping_.by)
            key.push_back(by == By::structure ? c.structure
                          : by == By::phase   ? c.phase
                          : by == By::work    ? c.work
                          : by == By::kind    ? static_cast<std::uint64_t>(c.kind)
                          : by == By::site    ? c.site
                                              : 0);
        if (static_key_) {
            counted.group = group_of(key, 0, 0, 0);
            continue;
        }
        const auto [found, fresh] = numbers.try_emplace(key, static_cast<std::uint32_t>(combined_.size()));
        if (fresh)
            combined_.push_back(key);
        counted.combined = found->second;
    }
    recent_.assign(static_key_ ? 0 : block.segments.size() * combined_.size(), {});
}

std::vector<Table::Cell> Touches::cells(std::size_t group, const traces::Description& d) const {
    std::vector<Table::Cell> out;
    for (std::size_t i = 0; i < grouping_.by.size(); ++i) {
        const std::uint64_t key = keys_[group][i];
        const auto in = [&](const std::vector<std::string>& names, const char* what) {
            out.emplace_back(key < names.size() ? names[key] : fmt::format("{} {}", what, key));
        };
        switch (grouping_.by[i]) {
        case By::structure:
            in(d.structures, "structure");
            break;
        case By::phase:
            in(d.phases, "phase");
            break;
        case By::work:
            in(d.work, "work");
            break;
        case By::thread:
            in(d.streams, "thread");
            break;
        case By::kind:
            out.emplace_back(traces::kind_names[key]);
            break;
        case By::site:
            out.emplace_back(key == 0                                     ? "unknown"
                             : !d.site_addresses && key <= d.sites.size() ? d.sites[key - 1]
                                                                          : fmt::format("0x{:x}", key));
            break;
        case By::window:
            out.emplace_back(key * grouping_.window);
            break;
        case By::tile: // by its upper left pixel
            out.emplace_back(key == 0 ? "none"
                                      : fmt::format("{},{}", d.picture.left(static_cast<std::uint32_t>(key)),
                                                    d.picture.top(static_cast<std::uint32_t>(key))));
            break;
        case By::all:
            break;
        }
    }
    return out;
}

std::string Touches::name(std::size_t group, const traces::Description& d) const {
    std::string out;
    for (const Table::Cell& cell : cells(group, d)) {
        const auto* const text = std::get_if<std::string>(&cell);
        out += (out.empty() ? "" : ", ") +
               (text != nullptr ? *text : std::to_string(std::get<std::uint64_t>(cell)));
    }
    return out.empty() ? "all" : out;
}

} // namespace analysis
