#include "sim/memory/line_map.h"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace sim {

std::uint64_t LineMap::end_of(const isa::address_space& space) {
    constexpr std::uint64_t granule = isa::address_space::granule;
    std::uint64_t end = 0;
    for (const isa::region& r : space.regions())
        end = std::max(end, (r.end + granule - 1) / granule * granule);
    return end;
}

LineMap::LineMap(const isa::address_space& space, unsigned line_shift, std::uint64_t page_table_bytes)
    : line_shift_(line_shift) {
    constexpr std::uint64_t granule = isa::address_space::granule;
    granule_count_ = (end_of(space) + page_table_bytes + granule - 1) / granule;
    granules_ = std::make_unique<Granule[]>(granule_count_);
    std::size_t next = 0;
    for (const isa::region& r : space.regions()) {
        const auto name = std::find(structures_.begin(), structures_.end(), r.structure);
        const auto index = static_cast<std::uint16_t>(name - structures_.begin());
        if (name == structures_.end())
            structures_.push_back(r.structure);
        for (; next < (r.end + granule - 1) / granule; ++next)
            granules_[next].structure = index;
    }
    if (page_table_bytes != 0) {
        for (; next < granule_count_; ++next)
            granules_[next].structure = static_cast<std::uint16_t>(structures_.size());
        structures_.emplace_back(page_tables);
    }
    structures_.emplace_back("spill");
    check_structures();
}

LineMap::LineMap(const std::vector<Extent>& extents, std::vector<std::string> structures, std::uint64_t end,
                 unsigned line_shift)
    : line_shift_(line_shift), structures_(std::move(structures)),
      granule_count_((end + isa::address_space::granule - 1) / isa::address_space::granule),
      granules_(std::make_unique<Granule[]>(granule_count_)) {
    constexpr std::uint64_t granule = isa::address_space::granule;
    std::size_t next = 0;
    for (const Extent& e : extents)
        for (; next < std::min((e.end + granule - 1) / granule, granule_count_); ++next)
            granules_[next].structure = e.structure;
    check_structures();
}

void LineMap::check_structures() const {
    if (structures_.size() >= std::size_t{1} << (Line::before_shift - level_bits))
        throw std::invalid_argument("too many structures");
}

LineMap::Line* LineMap::make_lines(std::size_t granule) {
    const std::lock_guard guard(making_);
    Line* there = granules_[granule].lines.load(std::memory_order_relaxed);
    if (there != nullptr)
        return there;
    auto lines = std::make_unique<Line[]>(lines_in_granule());
    for (std::size_t i = 0; i < lines_in_granule(); ++i)
        lines[i].kind_.store(kind_of(granules_[granule].structure, 0), std::memory_order_relaxed);
    granules_[granule].lines.store(lines.get(), std::memory_order_release);
    made_.push_back(std::move(lines));
    return made_.back().get();
}

void LineMap::note(std::uint64_t address, std::uint64_t bytes, std::uint32_t level_code, std::uint32_t tile,
                   std::vector<Line*>& notes) {
    const std::uint64_t last = (address + bytes - 1) >> line_shift_;
    for (std::uint64_t number = address >> line_shift_; number <= last; ++number) {
        Line* l = line(number << line_shift_);
        const std::uint64_t w = l->kind_.load(std::memory_order_relaxed);
        const std::uint64_t by = std::uint64_t{tile + 1} << Line::noted_shift;
        std::uint64_t before = w >> Line::before_shift & Line::kind_mask;
        if (w >> Line::noted_shift != tile + 1) {
            before = w & Line::kind_mask;
            notes.push_back(l);
        }
        const std::uint64_t kind =
            kind_of(structure_of(static_cast<LineKind>(w & Line::kind_mask)), level_code);
        l->kind_.store(by | before << Line::before_shift | kind, std::memory_order_relaxed);
    }
}

void LineMap::note_level(std::uint64_t address, std::uint64_t bytes, int level, std::uint32_t tile,
                         std::vector<Line*>& notes) {
    note(address, bytes, static_cast<std::uint32_t>(std::clamp(level, -127, 127) + 128), tile, notes);
}

void LineMap::note_level_of(std::uint64_t address, std::uint64_t bytes, std::uint64_t other,
                            std::uint32_t tile, std::vector<Line*>& notes) {
    note(address, bytes, line(other)->kind(tile) & ((1U << level_bits) - 1), tile, notes);
}

void LineMap::publish(std::vector<Line*>& notes) {
    for (Line* l : notes)
        l->kind_.store(l->kind_.load(std::memory_order_relaxed) & Line::kind_mask, std::memory_order_relaxed);
    notes.clear();
}

std::optional<int> LineMap::level_of(LineKind kind) {
    const std::uint32_t code = kind & ((1U << level_bits) - 1);
    return code == 0 ? std::nullopt : std::optional(static_cast<int>(code) - 128);
}

void LineMap::forget_touched() {
    for (std::size_t g = 0; g < granule_count_; ++g)
        if (Line* lines = granules_[g].lines.load(std::memory_order_relaxed); lines != nullptr)
            for (std::size_t i = 0; i < lines_in_granule(); ++i)
                lines[i].touched_.store(0, std::memory_order_relaxed);
}

std::vector<TouchedLines> LineMap::touched(std::size_t together) const {
    std::map<std::pair<std::size_t, std::uint64_t>, std::uint64_t> counts;
    for (std::size_t g = 0; g < granule_count_; ++g) {
        const Line* lines = granules_[g].lines.load(std::memory_order_relaxed);
        for (std::size_t i = 0; lines != nullptr && i < lines_in_granule(); i += together) {
            std::uint64_t columns = 0;
            for (std::size_t k = i; k < std::min(i + together, lines_in_granule()); ++k)
                columns |= lines[k].touched_.load(std::memory_order_relaxed);
            if (columns != 0)
                ++counts[{granules_[g].structure, columns}];
        }
    }
    std::vector<TouchedLines> out;
    for (const auto& [key, count] : counts)
        out.push_back({key.first, key.second, count});
    return out;
}

} // namespace sim
