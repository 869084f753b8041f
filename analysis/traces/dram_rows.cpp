#include "analysis/traces/dram_rows.h"

namespace analysis {

DramRows::DramRows(const sim::MemoryConfig& config, std::size_t reach)
    : mapping_(config), ranks_(static_cast<std::uint64_t>(config.ranks)),
      bank_groups_(static_cast<std::uint64_t>(config.bank_groups)),
      banks_of_group_(static_cast<std::uint64_t>(config.banks)), reach_(reach) {
    const auto banks = static_cast<std::size_t>(static_cast<std::uint64_t>(config.channels) * ranks_ *
                                                bank_groups_ * banks_of_group_);
    open_.assign(banks, closed);
    bursts_.assign(banks, 0);
    in_reach_.assign(banks, 0);
}

void DramRows::touch(std::uint64_t address, std::uint32_t group) {
    const sim::DramPlace place = mapping_.locate(address);
    const auto bank = static_cast<std::size_t>(
        ((place.channel * ranks_ + place.rank) * bank_groups_ + place.group) * banks_of_group_ + place.bank);
    if (group >= groups_.size())
        groups_.resize(std::size_t{group} + 1);
    Group& g = groups_[group];
    ++g.bursts;
    ++bursts_[bank];
    ++(open_[bank] == place.row ? g.hits : open_[bank] == closed ? g.empties : g.conflicts);
    open_[bank] = place.row;
    g.rows += rows_.insert(place.row * open_.size() + bank).second ? 1 : 0;
    if (last_.size() < reach_) {
        last_.push_back(static_cast<std::uint32_t>(bank));
    } else {
        different_ -= --in_reach_[last_[next_]] == 0 ? 1 : 0;
        last_[next_] = static_cast<std::uint32_t>(bank);
        next_ = (next_ + 1) % reach_;
    }
    different_ += in_reach_[bank]++ == 0 ? 1 : 0;
    g.banks += different_;
}

} // namespace analysis
