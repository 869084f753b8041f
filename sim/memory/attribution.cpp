#include "sim/memory/attribution.h"

#include <algorithm>

namespace sim {

Attribution::Attribution(const isa::address_space& space, std::size_t phases) : phases_(phases) {
    for (const isa::region& r : space.regions()) {
        auto name = std::find(structures_.begin(), structures_.end(), r.structure);
        auto index = static_cast<std::uint16_t>(name - structures_.begin());
        if (name == structures_.end())
            structures_.push_back(r.structure);
        std::uint64_t end = (r.end + isa::address_space::granule - 1) / isa::address_space::granule;
        structure_of_.resize(std::max<std::size_t>(structure_of_.size(), end), index);
        std::fill(structure_of_.begin() + static_cast<std::ptrdiff_t>(r.begin / isa::address_space::granule),
                  structure_of_.begin() + static_cast<std::ptrdiff_t>(end), index);
    }
    structures_.emplace_back("spill");
    cells_.resize(structures_.size() * phases_);
}

} // namespace sim
