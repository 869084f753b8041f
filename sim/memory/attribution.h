// Which traffic cell an access counts in, and which columns have touched which lines. Structures are the
// names of the address space's regions, in order of address, and `spill` for registers that were stored;
// where somebody has noted levels, a structure is divided by them. A column is a kind of work and a phase. A
// line has the level that was noted last for some of its bytes.
#pragma once

#include "isa/address_space.h"
#include "sim/memory/traffic.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sim {

class Attribution {
public:
    /// Lines are the L1s', of 2^line_shift bytes.
    Attribution(const isa::address_space& space, std::size_t columns, unsigned line_shift);

    /// The cell of an access to an L1, whose line counts as touched.
    Traffic& touch(std::uint64_t address, std::size_t column) {
        std::size_t granule = address / isa::address_space::granule;
        if (granule >= granules_.size())
            return cells_[spill_row_ * columns_ + column];
        Chunk& c = chunk(granule);
        std::size_t line = line_in_granule(address);
        c.touched[line] |= std::uint64_t{1} << column;
        return cells_[c.row[line] * columns_ + column];
    }
    /// The cell of anything else that happens to the line there.
    Traffic& cell(std::uint64_t address, std::size_t column) {
        std::size_t granule = address / isa::address_space::granule;
        if (granule >= granules_.size())
            return cells_[spill_row_ * columns_ + column];
        return cells_[chunk(granule).row[line_in_granule(address)] * columns_ + column];
    }
    /// From now on these bytes are of this level.
    void note_level(std::uint64_t address, std::uint64_t bytes, int level);
    /// ... or of the level of the line at `other`, if it has one.
    void note_level_of(std::uint64_t address, std::uint64_t bytes, std::uint64_t other);

    /// Where simulated memory ends and register spills begin.
    std::uint64_t spill_begin() const { return granules_.size() * isa::address_space::granule; }
    const std::vector<std::string>& structures() const { return structures_; }
    /// Cells in which anything happened, by structure, level and column.
    std::vector<TrafficRow> traffic() const;
    /// Lines of the structures but `spill`, by structure and by which columns touched them.
    std::vector<TouchedLines> touched() const;

private:
    struct Row {
        std::uint16_t structure;
        std::optional<int> level;
    };
    struct Chunk { // of a granule, by line
        std::unique_ptr<std::uint16_t[]> row;
        std::unique_ptr<std::uint64_t[]> touched; // a bit a column
    };
    struct Granule {
        std::uint16_t structure = 0;
        std::uint32_t chunk = 0; // 0: none yet
    };
    Chunk& chunk(std::size_t granule) {
        std::uint32_t number = granules_[granule].chunk;
        return number != 0 ? chunks_[number - 1] : make_chunk(granule);
    }
    std::size_t line_in_granule(std::uint64_t address) const {
        return address % isa::address_space::granule >> line_shift_;
    }
    Chunk& make_chunk(std::size_t granule);
    std::uint16_t row_of(std::uint16_t structure, std::optional<int> level);
    void set_rows(std::uint64_t address, std::uint64_t bytes, std::optional<int> level);

    std::size_t columns_;
    unsigned line_shift_;
    std::size_t spill_row_ = 0;
    std::vector<std::string> structures_;
    std::vector<Granule> granules_;
    std::vector<Chunk> chunks_;
    std::vector<Row> rows_; // first the structures, then what has levels
    std::map<std::pair<std::uint16_t, int>, std::uint16_t> row_of_level_;
    std::vector<Traffic> cells_; // [row * columns + column]
};

} // namespace sim
