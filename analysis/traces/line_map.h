// A hash table from lines to numbers, for analyses that look one up for every reference: open addressing by
// linear probing, of a power of two of places, at most half of them taken (Knuth, TAOCP 3, 6.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace analysis {

class LineMap {
public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    static constexpr std::size_t most_at_first = 1024;

    /// With so many places at first, a power of two.
    explicit LineMap(std::size_t places = most_at_first) : places_(places), mask_(places_.size() - 1) {}

    /// The number of a line, to read and to replace; `none` if it is new. Until the next call.
    std::uint32_t& operator[](std::uint64_t line) {
        if (2 * (taken_ + 1) > places_.size())
            grow();
        std::size_t at = home(line);
        while (places_[at].number != none && places_[at].line != line)
            at = (at + 1) & mask_;
        Place& place = places_[at];
        if (place.number == none) {
            place.line = line;
            ++taken_; // by the number that the caller gives it
        }
        return place.number;
    }
    /// The same without making room for it.
    std::uint32_t find(std::uint64_t line) const {
        std::size_t at = home(line);
        while (places_[at].number != none && places_[at].line != line)
            at = (at + 1) & mask_;
        return places_[at].number;
    }
    /// Takes a line out that is in.
    void erase(std::uint64_t line) {
        std::size_t hole = home(line);
        while (places_[hole].number == none || places_[hole].line != line)
            hole = (hole + 1) & mask_;
        // Those behind it that could not be found across a hole move into it.
        for (std::size_t at = (hole + 1) & mask_; places_[at].number != none; at = (at + 1) & mask_)
            if (((at - home(places_[at].line)) & mask_) >= ((at - hole) & mask_)) {
                places_[hole] = places_[at];
                hole = at;
            }
        places_[hole].number = none;
        --taken_;
    }
    std::size_t size() const { return taken_; }

private:
    struct Place {
        std::uint64_t line = 0;
        std::uint32_t number = none;
    };
    std::size_t home(std::uint64_t line) const {
        const std::uint64_t h = (line ^ line >> 29U) * 0x9E3779B97F4A7C15U;
        return static_cast<std::size_t>(h ^ h >> 32U) & mask_;
    }
    void grow() {
        std::vector<Place> old(places_.size() * 2);
        old.swap(places_);
        mask_ = places_.size() - 1;
        for (const Place& p : old)
            if (p.number != none) {
                std::size_t at = home(p.line);
                while (places_[at].number != none)
                    at = (at + 1) & mask_;
                places_[at] = p;
            }
    }

    std::vector<Place> places_;
    std::size_t mask_, taken_ = 0;
};

} // namespace analysis
