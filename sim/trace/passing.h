// How a reference passes from a level of caches to what lies below it, as a trace of that level says in
// traces::Class::detail, so that a replay asks the levels below for the same. In it: what an Access says of
// itself; which level is meant, where it is not the next one; where in the program the operation at hand
// stands, for prefetchers; and what was asked, where that was refused (traces::Kind::refused), which cores'
// references say, too.
#pragma once

#include "sim/memory/below.h"
#include "sim/memory/prefetcher.h"

#include <cstdint>

namespace sim {

class Passing {
public:
    /// What a level above had of a line that one below asked it for (traces::Kind::recall).
    enum Held : std::uint32_t { held = 1, changed = 2, owned = 4 };

    /// What was refused. `change`: a word that threads share, by a core.
    enum Asks : std::uint32_t { read, write, own, change };

    /// Of an access of the level below.
    static std::uint32_t of(const Access& a, const SiteAtHand& site) {
        return passes | bit(0, a.whole) | bit(1, a.followed) | bit(2, a.modify) | bit(3, a.forced) |
               bit(4, a.clean) | bit(5, a.exclusive) | bit(6, a.owned) | bit(7, a.stays) | number(site);
    }
    static std::uint32_t of(const Access& a, const SiteAtHand& site, Asks asks) {
        return of(a, site) | asks << level_shift;
    }
    static std::uint32_t of(Asks asks) { return passes | asks << level_shift; }
    /// Of word to a level: 1 is the L2, that of the caches that lie in a tile is what lies beyond.
    static std::uint32_t to(unsigned level) { return passes | level << level_shift; }
    static std::uint32_t of(Held what) { return passes | what; }

    explicit Passing(std::uint32_t detail) : detail_(detail) {}
    /// Whether it passes at all; else something was counted, and nobody below asked.
    bool any() const { return detail_ != 0; }
    unsigned level() const { return detail_ >> level_shift & 7U; }
    Asks asks() const { return static_cast<Asks>(detail_ >> level_shift & 3U); }
    bool has(Held what) const { return (detail_ & what) != 0; }
    void apply(Access& a) const {
        a.whole = has_bit(0);
        a.followed = has_bit(1);
        a.modify = has_bit(2);
        a.forced = has_bit(3);
        a.clean = has_bit(4);
        a.exclusive = has_bit(5);
        a.owned = has_bit(6);
        a.stays = has_bit(7);
    }
    SiteAtHand site() const {
        const std::uint32_t n = detail_ >> site_shift;
        return {n == 0 ? SiteAtHand::none : n == most_sites ? SiteAtHand::unnumbered : n - 1, false};
    }

private:
    static constexpr std::uint32_t passes = 1U << 8U, most_sites = 0xFFFF;
    static constexpr unsigned level_shift = 9, site_shift = 16;
    static std::uint32_t bit(unsigned n, bool on) { return on ? 1U << n : 0; }
    bool has_bit(unsigned n) const { return (detail_ >> n & 1U) != 0; }
    static std::uint32_t number(const SiteAtHand& site) {
        return site.number == SiteAtHand::none ? 0
               : site.number + 1 >= most_sites ? most_sites << site_shift
                                               : (site.number + 1) << site_shift;
    }

    std::uint32_t detail_;
};

} // namespace sim
