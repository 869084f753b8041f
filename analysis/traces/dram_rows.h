// How well references keep to the rows that a memory has open, and how many of its banks they use at once, by
// the simulator's own mapping of addresses.
#pragma once

#include "analysis/traces/touches.h"
#include "sim/memory/dram_mapping.h"

#include <cstddef>
#include <cstdint>
#include <unordered_set>
#include <vector>

namespace analysis {

/// Bursts in the order of the trace, each bank with the row open that it was asked for last (open-page
/// policy, no refresh). Not modelled: time, queues, a controller that puts hits first (FR-FCFS) and so has
/// more of them.
class DramRows {
public:
    /// `reach`: bursts of which banks are counted, at least 1: as a queue of so many sees them.
    DramRows(const sim::MemoryConfig& config, std::size_t reach);

    /// Of a burst.
    void touch(std::uint64_t address, std::uint32_t group);

    struct Group {
        std::uint64_t bursts = 0;
        std::uint64_t hits = 0;      // the row is open
        std::uint64_t empties = 0;   // the bank has none open yet
        std::uint64_t conflicts = 0; // another one is
        std::uint64_t rows = 0;      // different ones that it asked for first
        std::uint64_t banks = 0;     // different ones among the last `reach` bursts, summed over bursts
        std::uint64_t activations() const { return empties + conflicts; }
    };
    const std::vector<Group>& groups() const { return groups_; }
    /// Bursts of each bank: channel, then rank, bank group, bank.
    const std::vector<std::uint64_t>& banks() const { return bursts_; }

private:
    static constexpr std::uint64_t closed = ~std::uint64_t{0};
    sim::DramMapping mapping_;
    std::uint64_t ranks_, bank_groups_, banks_of_group_;
    std::vector<Group> groups_;
    std::vector<std::uint64_t> open_, bursts_; // by bank
    std::unordered_set<std::uint64_t> rows_;   // asked for: row * banks + bank
    std::vector<std::uint32_t> last_;          // banks of the last bursts, a ring
    std::size_t reach_, next_ = 0;
    std::vector<std::uint32_t> in_reach_; // bursts of each bank in the ring
    std::uint64_t different_ = 0;
};

} // namespace analysis
