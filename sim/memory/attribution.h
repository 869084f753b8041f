// Which traffic cell an address and a phase count in. Structures are the names of the address space's
// regions, in order of address, and `spill` for registers that were stored.
#pragma once

#include "isa/address_space.h"
#include "sim/memory/traffic.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sim {

class Attribution {
public:
    Attribution(const isa::address_space& space, std::size_t phases);

    /// Aborts if the address lies in no region.
    Traffic& cell(std::uint64_t address, std::size_t phase) {
        std::size_t granule = address / isa::address_space::granule;
        std::size_t structure =
            granule < structure_of_.size() ? structure_of_[granule] : structures_.size() - 1;
        return cells_[structure * phases_ + phase];
    }
    /// Where simulated memory ends and register spills begin.
    std::uint64_t spill_begin() const { return structure_of_.size() * isa::address_space::granule; }
    const std::vector<std::string>& structures() const { return structures_; }
    const std::vector<Traffic>& cells() const { return cells_; } // [structure * phases + phase]

private:
    std::size_t phases_;
    std::vector<std::string> structures_;
    std::vector<std::uint16_t> structure_of_; // by granule
    std::vector<Traffic> cells_;
};

} // namespace sim
