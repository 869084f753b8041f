#include "sim/memory/attribution.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace sim {

Attribution::Attribution(const isa::address_space& space, std::size_t columns, unsigned line_shift)
    : columns_(columns), line_shift_(line_shift) {
    if (columns > max_columns)
        throw std::invalid_argument("too many phases times kinds of work");
    for (const isa::region& r : space.regions()) {
        auto name = std::find(structures_.begin(), structures_.end(), r.structure);
        auto index = static_cast<std::uint16_t>(name - structures_.begin());
        if (name == structures_.end())
            structures_.push_back(r.structure);
        std::uint64_t end = (r.end + isa::address_space::granule - 1) / isa::address_space::granule;
        granules_.resize(std::max<std::size_t>(granules_.size(), end), {index, 0});
        std::fill(granules_.begin() + static_cast<std::ptrdiff_t>(r.begin / isa::address_space::granule),
                  granules_.begin() + static_cast<std::ptrdiff_t>(end), Granule{index, 0});
    }
    spill_row_ = structures_.size();
    structures_.emplace_back("spill");
    for (std::size_t s = 0; s < structures_.size(); ++s)
        rows_.push_back({static_cast<std::uint16_t>(s), {}});
    cells_.resize(rows_.size() * columns_);
}

Attribution::Chunk& Attribution::make_chunk(std::size_t granule) {
    std::size_t lines = isa::address_space::granule >> line_shift_;
    Chunk c{std::make_unique<std::uint16_t[]>(lines), std::make_unique<std::uint64_t[]>(lines)};
    std::fill_n(c.row.get(), lines, granules_[granule].structure);
    chunks_.push_back(std::move(c));
    granules_[granule].chunk = static_cast<std::uint32_t>(chunks_.size());
    return chunks_.back();
}

std::uint16_t Attribution::row_of(std::uint16_t structure, std::optional<int> level) {
    if (!level)
        return structure;
    auto [found, made] =
        row_of_level_.try_emplace({structure, *level}, static_cast<std::uint16_t>(rows_.size()));
    if (made) {
        rows_.push_back({structure, level});
        cells_.resize(rows_.size() * columns_);
    }
    return found->second;
}

void Attribution::set_rows(std::uint64_t address, std::uint64_t bytes, std::optional<int> level) {
    std::uint64_t last = (address + bytes - 1) >> line_shift_;
    for (std::uint64_t line = address >> line_shift_; line <= last; ++line) {
        std::uint64_t at = line << line_shift_;
        std::size_t granule = at / isa::address_space::granule;
        chunk(granule).row[line_in_granule(at)] = row_of(granules_[granule].structure, level);
    }
}

void Attribution::note_level(std::uint64_t address, std::uint64_t bytes, int level) {
    set_rows(address, bytes, level);
}

void Attribution::note_level_of(std::uint64_t address, std::uint64_t bytes, std::uint64_t other) {
    set_rows(address, bytes,
             rows_[chunk(other / isa::address_space::granule).row[line_in_granule(other)]].level);
}

std::vector<TrafficRow> Attribution::traffic() const {
    std::vector<TrafficRow> out;
    for (std::size_t row = 0; row < rows_.size(); ++row)
        for (std::size_t column = 0; column < columns_; ++column) {
            const Traffic& t = cells_[row * columns_ + column];
            if (!is_empty(t))
                out.push_back({rows_[row].structure, rows_[row].level, column, t});
        }
    std::sort(out.begin(), out.end(), [](const TrafficRow& a, const TrafficRow& b) {
        return std::tie(a.structure, a.level, a.column) < std::tie(b.structure, b.level, b.column);
    });
    return out;
}

std::vector<TouchedLines> Attribution::touched() const {
    std::map<std::pair<std::size_t, std::uint64_t>, std::uint64_t> lines;
    for (const Granule& g : granules_) {
        if (g.chunk == 0)
            continue;
        const Chunk& c = chunks_[g.chunk - 1];
        for (std::size_t line = 0; line < isa::address_space::granule >> line_shift_; ++line)
            if (c.touched[line] != 0)
                ++lines[{g.structure, c.touched[line]}];
    }
    std::vector<TouchedLines> out;
    for (const auto& [key, count] : lines)
        out.push_back({key.first, key.second, count});
    return out;
}

} // namespace sim
