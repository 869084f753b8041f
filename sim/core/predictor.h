// Two-bit counters (Smith 1981), chosen by the branch's site and, as far as core.predictor_history says, the
// outcomes of the thread's last branches. Threads of a core share the counters. There are no program
// counters: a site is a line of source, and stands for all copies that a compiler makes of it. Tables:
//   counters  one for each site and history: none is shared (Yeh and Patt 1991, with unlimited tables)
//   bimodal   core.predictor_entries of them, by site
//   gshare    as many, by site and history, added bit by bit (McFarling 1993)
// In the tables of limited size a site's place is its number in the order in which the core first met it, as
// if code were laid out so. Not modelled: targets, tags, the delay of an update.
#pragma once

#include "sim/config/config.h"

#include <cstdint>
#include <vector>

namespace sim {

class Predictor {
public:
    explicit Predictor(const CoreConfig& c)
        : history_bits_(static_cast<unsigned>(c.predictor_history)),
          unlimited_(c.predictor != "bimodal" && c.predictor != "gshare") {
        if (!unlimited_)
            counters_.assign(static_cast<std::size_t>(c.predictor_entries), weakly_taken);
        if (c.predictor == "bimodal")
            history_bits_ = 0;
    }

    /// Predicts, learns, and says whether the prediction was right. `history` is the thread's.
    bool right(std::uint32_t site, std::uint32_t& history, bool taken) {
        std::uint32_t kept = history & ((1U << history_bits_) - 1U);
        std::uint8_t& counter = unlimited_ ? own(site, kept) : shared(site, kept);
        bool predicted = counter >= weakly_taken;
        if (taken)
            counter = counter == 3 ? counter : static_cast<std::uint8_t>(counter + 1);
        else
            counter = counter == 0 ? counter : static_cast<std::uint8_t>(counter - 1);
        history = history << 1U | (taken ? 1U : 0U);
        return predicted == taken;
    }

private:
    std::uint8_t& own(std::uint32_t site, std::uint32_t kept) {
        std::size_t index = (static_cast<std::size_t>(site) << history_bits_) + kept;
        if (index >= counters_.size())
            counters_.resize(2 * index + 64, weakly_taken);
        return counters_[index];
    }
    std::uint8_t& shared(std::uint32_t site, std::uint32_t kept) {
        if (site >= places_.size())
            places_.resize(2 * static_cast<std::size_t>(site) + 64, nowhere);
        if (places_[site] == nowhere)
            places_[site] = next_place_++;
        return counters_[(places_[site] ^ kept) & (counters_.size() - 1)];
    }

    static constexpr std::uint8_t weakly_taken = 2; // loops close more often than they open
    static constexpr std::uint32_t nowhere = ~std::uint32_t{0};
    unsigned history_bits_;
    bool unlimited_;
    std::vector<std::uint8_t> counters_;
    std::vector<std::uint32_t> places_; // of sites in limited tables
    std::uint32_t next_place_ = 0;
};

} // namespace sim
