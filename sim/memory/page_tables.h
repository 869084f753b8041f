// Where the page tables of simulated memory lie: a radix tree of tables of 512 entries of 8 bytes, as in
// x86-64. Virtual addresses are those of the simulated memory, registers' spills included; the tables of a
// level lie one after the other, behind the data. Not modelled: other address spaces; pages of several sizes;
// that an operating system scatters tables and pages over memory; accessed and dirty bits.
#pragma once

#include "sim/config/config.h"

#include <cstdint>
#include <vector>

namespace sim {

class PageTables {
public:
    /// For addresses below `end`, behind which the tables begin, and `more` bytes behind these.
    PageTables(const TlbConfig& config, std::uint64_t end, std::uint64_t more);

    /// Tables that a walk reads, from the root (levels() - 1) to the one that has the pages (0).
    unsigned levels() const { return static_cast<unsigned>(begins_.size()); }
    /// Which entry of a level stands for a page, counted through all of its tables.
    static std::uint64_t index(unsigned level, std::uint64_t page) { return page >> (bits * level); }
    /// Where that entry lies.
    std::uint64_t address(unsigned level, std::uint64_t page) const {
        return begins_[level] + index(level, page) * entry_bytes;
    }
    std::uint64_t bytes() const { return bytes_; }

    static constexpr unsigned bits = 9; // of a page's number, that a level translates
    static constexpr std::uint64_t entry_bytes = 8;

private:
    void place(const TlbConfig& config, std::uint64_t begin, std::uint64_t end);

    std::vector<std::uint64_t> begins_; // by level
    std::uint64_t bytes_ = 0;
};

} // namespace sim
