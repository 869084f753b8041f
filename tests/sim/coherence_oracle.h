// MESI as a table of states: for every line who has it in which state, of caches that never evict but what a
// directory recalls. Every tile has cores with an L1 each and a last cache below them. Written for the tests
// alone; slow and plain.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace sim::test {

struct OracleCounts {
    std::uint64_t l1_misses = 0, l1_upgrades = 0, l1_invalidations = 0, l1_downgrades = 0, l1_coherence = 0;
    std::uint64_t l2_misses = 0, l2_upgrades = 0, l2_invalidations = 0, l2_downgrades = 0, l2_coherence = 0;
    std::uint64_t reads = 0, writes = 0, exclusive = 0, shared = 0;
    std::uint64_t forwards_dirty = 0, forwards_clean = 0, invalidations = 0, fetched = 0; // from below
    std::uint64_t recalled_lines = 0, recalls = 0;

    /// Requests that a directory hears of.
    std::uint64_t asked() const { return reads + writes + l2_upgrades; }

    bool operator==(const OracleCounts&) const = default;
};

class CoherenceOracle {
public:
    CoherenceOracle(int tiles, int cores) : tiles_(tiles), cores_(cores) {}

    void access(int tile, int core, int line, bool write) {
        Line& l = lines_.try_emplace(line, make()).first->second;
        if (write)
            write_line(l, tile, core);
        else
            read_line(l, tile, core);
    }
    /// Everybody drops the line; what was changed is written back.
    void recall(int line) {
        ++counts_.recalled_lines;
        for (Tile& t : lines_.at(line)) {
            if (t.l2.state == invalid)
                continue;
            ++counts_.recalls;
            counts_.l2_downgrades += changed(t) ? 1 : 0;
            share_l1s(t, -1);
            take_l1s(t, -1);
            counts_.l2_invalidations += take(t.l2) ? 1 : 0;
        }
    }
    const OracleCounts& counts() const { return counts_; }

private:
    enum State { invalid, shared, exclusive, modified };
    struct Copy {
        State state = invalid;
        bool taken = false; // by another's write
    };
    struct Tile {
        Copy l2;
        std::vector<Copy> l1;
    };
    using Line = std::vector<Tile>;

    Line make() const {
        Tile t;
        t.l1.resize(static_cast<std::size_t>(cores_));
        return Line(static_cast<std::size_t>(tiles_), t);
    }
    static bool may_write(const Copy& c) { return c.state == exclusive || c.state == modified; }
    static bool changed(const Tile& t) {
        bool any = t.l2.state == modified;
        for (const Copy& c : t.l1)
            any |= c.state == modified;
        return any;
    }
    /// Returns whether it was there.
    static bool take(Copy& c) {
        const bool was = c.state != invalid;
        c.taken |= was;
        c.state = invalid;
        return was;
    }
    void take_l1s(Tile& t, int but) {
        for (int i = 0; i < cores_; ++i) {
            Copy& c = t.l1[static_cast<std::size_t>(i)];
            if (i == but)
                continue;
            if (c.state == modified)
                t.l2.state = modified;
            counts_.l1_invalidations += take(c) ? 1 : 0;
        }
    }
    /// Copies of the tile are shared and clean; the L2 has what was changed.
    void share_l1s(Tile& t, int but) {
        for (int i = 0; i < cores_; ++i) {
            Copy& c = t.l1[static_cast<std::size_t>(i)];
            if (i == but || c.state == invalid)
                continue;
            if (c.state == modified) {
                ++counts_.l1_downgrades;
                t.l2.state = modified;
            }
            c.state = shared;
        }
    }
    /// What others have when somebody reads (or writes) what his tile lacks.
    void ask_others(Line& l, int tile, bool write) {
        for (int i = 0; i < tiles_; ++i) {
            Tile& t = l[static_cast<std::size_t>(i)];
            if (i == tile || t.l2.state == invalid)
                continue;
            if (may_write(t.l2)) {
                const bool dirty = changed(t);
                ++(dirty ? counts_.forwards_dirty : counts_.forwards_clean);
                if (!write) {
                    share_l1s(t, -1);
                    t.l2.state = shared;
                    counts_.l2_downgrades += dirty ? 1 : 0;
                    continue;
                }
            } else if (write) {
                ++counts_.invalidations;
            } else {
                continue;
            }
            take_l1s(t, -1);
            counts_.l2_invalidations += take(t.l2) ? 1 : 0;
        }
    }
    bool elsewhere(const Line& l, int tile, bool to_write) const {
        bool any = false;
        for (int i = 0; i < tiles_; ++i) {
            const Copy& c = l[static_cast<std::size_t>(i)].l2;
            any |= i != tile && (to_write ? may_write(c) : c.state != invalid);
        }
        return any;
    }
    void miss(Copy& c, std::uint64_t& misses, std::uint64_t& coherence) {
        ++misses;
        coherence += c.taken ? 1 : 0;
        c.taken = false;
    }
    void read_line(Line& l, int tile, int core) {
        Tile& t = l[static_cast<std::size_t>(tile)];
        Copy& own = t.l1[static_cast<std::size_t>(core)];
        if (own.state != invalid)
            return;
        miss(own, counts_.l1_misses, counts_.l1_coherence);
        if (t.l2.state == invalid) {
            miss(t.l2, counts_.l2_misses, counts_.l2_coherence);
            ++counts_.reads;
            const bool others = elsewhere(l, tile, false);
            counts_.fetched += elsewhere(l, tile, true) ? 0 : 1;
            ask_others(l, tile, false);
            t.l2.state = others ? shared : exclusive;
            ++(others ? counts_.shared : counts_.exclusive);
        }
        bool alone = may_write(t.l2);
        for (const Copy& c : t.l1)
            alone &= c.state == invalid;
        share_l1s(t, core);
        own.state = alone ? exclusive : shared;
    }
    void write_line(Line& l, int tile, int core) {
        Tile& t = l[static_cast<std::size_t>(tile)];
        Copy& own = t.l1[static_cast<std::size_t>(core)];
        if (!may_write(own)) {
            if (own.state == invalid)
                miss(own, counts_.l1_misses, counts_.l1_coherence);
            else
                ++counts_.l1_upgrades;
            if (!may_write(t.l2)) {
                if (t.l2.state == invalid) {
                    miss(t.l2, counts_.l2_misses, counts_.l2_coherence);
                    ++counts_.writes;
                    counts_.fetched += elsewhere(l, tile, true) ? 0 : 1;
                } else {
                    ++counts_.l2_upgrades;
                }
                ask_others(l, tile, true);
                t.l2.state = exclusive;
            }
            take_l1s(t, core);
        }
        own.state = modified;
    }

    int tiles_, cores_;
    std::map<int, Line> lines_;
    OracleCounts counts_;
};

} // namespace sim::test
