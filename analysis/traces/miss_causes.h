// Why caches miss: compulsory, capacity and conflict (Hill and Smith, IEEE Transactions on Computers 1989),
// and coherence, true and false sharing told apart as Dubois et al. (ISCA 1993) do.
#pragma once

#include "analysis/traces/coherent_caches.h"

#include <cstdint>
#include <vector>

namespace analysis {

/// Of one shape of caches, each used by some threads. Beside each cache stands a fully associative one of as
/// many lines that sees the same. A miss is
/// * compulsory: the cache never had the line;
/// * of sharing: it, or the other one, would have had it if no other cache had written to it: truly, if
///   something that was written elsewhere meanwhile is touched before the line goes again, else falsely;
/// * conflict: the fully associative one has it;
/// * capacity: it has not either.
/// Sets spare some misses, too: those of a fully associative cache are not the sum without conflicts.
class MissCauses {
public:
    explicit MissCauses(CacheShape shape)
        : real_(shape, {}), full_({1, shape.lines(), shape.line_bytes}, {}) {}

    void touch(const Touch& touch, std::uint32_t cache) {
        Watch& watch = real_.observer();
        if (touch.group >= watch.groups.size())
            watch.groups.resize(touch.group + 1);
        ++watch.groups[touch.group].references;
        watch.beside = full_.find(touch.line, cache);
        real_.touch(touch, cache);
        full_.touch(touch, cache);
    }
    /// After the last touch: what lines still in caches missed for is settled.
    void finish() { real_.finish(); }

    struct Group {
        std::uint64_t references = 0, compulsory = 0, capacity = 0, conflict = 0, true_sharing = 0,
                      false_sharing = 0;
        std::uint64_t misses() const {
            return compulsory + capacity + conflict + true_sharing + false_sharing;
        }
    };
    /// Of references by their groups.
    const std::vector<Group>& groups() const { return real_.observer().groups; }
    std::uint64_t caches() const { return real_.caches(); }

private:
    struct Watch {
        void filled(const HeldLine&, Copy& copy, const Touch&) {
            Group& g = groups[copy.group];
            copy.marked = !copy.fresh && (copy.dropped || beside->dropped);
            copy.met = false;
            if (copy.fresh)
                ++g.compulsory;
            else if (!copy.marked) // else it is known of which sharing when it goes
                ++(beside->there ? g.conflict : g.capacity);
        }
        void used(Copy& copy, std::uint64_t parts) { copy.met = copy.met || (copy.news & parts) != 0; }
        void left(const HeldLine&, const Copy& copy) {
            if (copy.marked)
                ++(copy.met ? groups[copy.group].true_sharing : groups[copy.group].false_sharing);
        }

        std::vector<Group> groups;
        const Copy* beside = nullptr; // of the touch at hand, in the fully associative cache
    };
    struct Nobody {
        void filled(const HeldLine&, const Copy&, const Touch&) {}
        void used(const Copy&, std::uint64_t) {}
        void left(const HeldLine&, const Copy&) {}
    };
    CoherentCaches<Watch> real_;
    CoherentCaches<Nobody> full_;
};

} // namespace analysis
