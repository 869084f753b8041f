#include "sim/memory/owner_costs.h"

#include <bit>

namespace sim {

std::vector<OwnerFigure> owner_figures(unsigned cache_levels) {
    std::vector<OwnerFigure> out{
        {"cycles", &ThreadCost::cycles, nullptr, "threads' cycles"},
        {"stalled", &ThreadCost::stalled, nullptr, "of these, waiting for caches, memory and translation"},
        {"waiting", &ThreadCost::waiting, nullptr, "of the cycles, waiting for shared words: what others do"},
        {"instructions", &ThreadCost::instructions, nullptr, "machine instructions"}};
    constexpr const char* names[] = {"l1_misses", "l2_misses", "l3_misses", "l4_misses", "l5_misses"};
    constexpr const char* meanings[] = {"misses of L1s", "misses of L2s", "misses of L3s", "misses of L4s",
                                        "misses of L5s"};
    for (unsigned level = 0; level < cache_levels; ++level)
        out.push_back({names[level], nullptr, traffic_of_level[level].misses, meanings[level]});
    out.push_back({"dram_reads", nullptr, &Traffic::memory_reads, "lines read from memory"});
    out.push_back({"dram_writes", nullptr, &Traffic::memory_writes, "lines written to memory"});
    return out;
}

void OwnerCosts::begin(std::size_t tiles, std::size_t lanes, std::size_t phases) {
    lanes_ = lanes;
    phases_ = phases;
    tiles_.resize(tiles);
    forget();
}

void OwnerCosts::forget() {
    for (OfTile& tile : tiles_) {
        tile = {};
        tile.parties.emplace_back();
    }
}

std::size_t OwnerCosts::party_of(std::size_t tile, const Key& key) {
    OfTile& own = tiles_[tile];
    const auto [known, is_new] = own.known.try_emplace(key, own.parties.size());
    if (is_new)
        own.parties.push_back({key.block, key.lanes, {}, {}});
    return (tile << number_bits | known->second) << column_bits;
}

std::size_t OwnerCosts::party(std::size_t tile, const std::int32_t* owner, std::uint64_t lanes) {
    if (lanes == 0)
        return 0;
    std::vector<std::int32_t>& owners = tiles_[tile].owners;
    const std::size_t block = owners.size() / lanes_;
    owners.insert(owners.end(), owner, owner + lanes_);
    return party_of(tile, {block, lanes});
}

std::size_t OwnerCosts::narrowed(std::size_t party, std::uint64_t lanes) {
    const std::size_t tile = tile_of(party), number = number_of(party);
    if (number == 0)
        return party;
    const Party& whole = tiles_[tile].parties[number];
    const std::uint64_t left = whole.lanes & lanes;
    return left == 0 ? party : party_of(tile, {whole.block, left});
}

std::int32_t OwnerCosts::first_owner(std::size_t column) const {
    const std::size_t number = number_of(column);
    if (number == 0)
        return -1;
    const OfTile& tile = tiles_[tile_of(column)];
    const Party& party = tile.parties[number];
    return tile.owners[party.block * lanes_ + static_cast<std::size_t>(std::countr_zero(party.lanes))];
}

OwnerCost& OwnerCosts::cost(std::size_t tile, std::size_t column) {
    const std::size_t number = number_of(column), phase = plain_column(column) % phases_;
    Party& party = tiles_[number == 0 ? tile : tile_of(column)].parties[number];
    return phase < builds_.size() && builds_[phase] ? party.builds : party.others;
}

void OwnerCosts::count(std::size_t tile, std::size_t column, const ThreadCost& what) {
    ThreadCost& all = cost(tile, column).thread;
    all.cycles += what.cycles;
    all.stalled += what.stalled;
    all.waiting += what.waiting;
    all.instructions += what.instructions;
}

/// Of an amount for n lanes, those before lane i get (amount x i + o) / n together: o, another one for each
/// party, says whose the rest is.
void OwnerCosts::share(const OwnerFigure& figure, bool builds_alone,
                       const std::function<void(std::int32_t, std::uint64_t)>& visit) const {
    for (const OfTile& tile : tiles_)
        for (std::size_t number = 1; number < tile.parties.size(); ++number) {
            const Party& p = tile.parties[number];
            const std::uint64_t amount = figure.of(p.builds) + (builds_alone ? 0 : figure.of(p.others));
            const auto n = static_cast<std::uint64_t>(std::popcount(p.lanes));
            const std::uint64_t each = amount / n, rest = amount % n;
            std::uint64_t given = number % n;
            for (std::uint64_t left = p.lanes; left != 0; left &= left - 1) {
                given += rest;
                const std::uint64_t more = given >= n ? 1 : 0;
                given -= more * n;
                const auto lane = static_cast<std::size_t>(std::countr_zero(left));
                visit(tile.owners[p.block * lanes_ + lane], each + more);
            }
        }
}

OwnerSum OwnerCosts::sum(const OwnerFigure& figure) const {
    OwnerSum sum{figure.name};
    for (const OfTile& tile : tiles_)
        for (const Party& p : tile.parties) {
            const std::uint64_t all = figure.of(p.builds) + figure.of(p.others);
            if (p.lanes == 0) {
                sum.nobody += all;
            } else {
                sum.owners += all;
                sum.builds += figure.of(p.builds);
            }
        }
    return sum;
}

} // namespace sim
