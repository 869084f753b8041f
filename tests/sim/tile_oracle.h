// Levels of caches in order of time to compare with: every cycle one by one, lists of lines, nothing in
// advance. Cores' L1s over one cache a level, memory that takes the same time for every line; LRU,
// write-back, write-allocate, room for every write-back. Written for the tests alone, in no way like
// sim/machine.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <vector>

namespace sim::test {

class TileOracle {
public:
    using Time = std::uint64_t;
    struct Level {
        std::uint64_t lines, ways, latency, mshrs, banks, bank_cycles; // mshrs 0: no limit; of a line
    };
    struct Counts {
        std::uint64_t reads = 0, writes = 0, hits = 0, misses = 0, fills = 0, write_backs = 0;
        bool operator==(const Counts&) const = default;
    };
    struct Access {
        Time at; // at the earliest, and no earlier than the cycle after the core's last one was accepted
        std::uint64_t line;
        bool write;
    };

    TileOracle(std::size_t cores, const Level& l1, const std::vector<Level>& below, Time memory)
        : memory_(memory) {
        for (std::size_t c = 0; c < cores; ++c)
            nodes_.emplace_back(l1);
        for (const Level& l : below)
            nodes_.emplace_back(l);
        cores_ = cores;
    }
    /// When each core has the line of each of its accesses.
    std::vector<std::vector<Time>> run(const std::vector<std::vector<Access>>& programs) {
        std::vector<std::size_t> next(cores_, 0);
        std::vector<Time> free(cores_, 0);
        std::vector<std::vector<std::size_t>> values(cores_);
        for (Time now = 0;; ++now) {
            bool busy = false;
            for (std::size_t n = cores_; n < nodes_.size(); ++n)
                busy |= serve(n, now);
            for (std::size_t c = 0; c < cores_; ++c) {
                if (next[c] == programs[c].size())
                    continue;
                busy = true;
                const Access& a = programs[c][next[c]];
                if (now < std::max(a.at, free[c]))
                    continue;
                const std::size_t value = touch(c, a.line, a.write, false, now, c);
                if (value == refused)
                    continue;
                ++(a.write ? nodes_[c].counts.writes : nodes_[c].counts.reads);
                values[c].push_back(value);
                free[c] = now + 1;
                ++next[c];
            }
            if (!busy)
                break;
        }
        std::vector<std::vector<Time>> out(cores_);
        for (std::size_t c = 0; c < cores_; ++c)
            for (const std::size_t v : values[c])
                out[c].push_back(when(v));
        return out;
    }
    /// Of the cores' L1s, then the levels below.
    const Counts& counts(std::size_t node) const { return nodes_[node].counts; }

private:
    static constexpr std::size_t refused = ~std::size_t{0}, none = refused;
    static constexpr Time never = ~Time{0};

    /// A time: known, or that of another one, but no earlier than `least`.
    struct Value {
        Time least = 0;
        std::size_t other = none;
        bool known = false;
    };
    struct Line {
        std::uint64_t number;
        bool dirty;
        std::size_t filled; // the value
    };
    struct Asked {
        std::size_t from; // which cache
        std::uint64_t order;
        Time at;
        std::uint64_t line;
        bool write, booked;
        std::size_t value;
    };
    struct Node {
        explicit Node(const Level& l) : level(l), sets(l.lines / l.ways), bank(l.banks, 0) {}
        Level level;
        std::vector<std::list<Line>> sets; // the last one used first
        std::vector<Time> bank;            // is free from then on
        std::vector<std::size_t> mshrs;
        std::vector<Asked> coming;
        std::deque<Asked> waiting;
        Counts counts;
    };

    std::size_t make(Time least, std::size_t other, bool known) {
        values_.push_back({least, other, known});
        return values_.size() - 1;
    }
    Time when(std::size_t v) const {
        const Value& x = values_[v];
        if (!x.known)
            return never;
        if (x.other == none)
            return x.least;
        const Time t = when(x.other);
        return t == never ? never : std::max(t, x.least);
    }
    std::size_t ask(std::size_t from, std::uint64_t line, bool write, Time at) {
        const std::size_t below = from < cores_ ? cores_ : from + 1;
        if (below == nodes_.size())
            return make(write ? at : at + memory_, none, true);
        const std::size_t value = make(0, none, false);
        nodes_[below].coming.push_back({from, order_++, at, line, write, false, value});
        return value;
    }
    /// All that happens in a cache in this cycle; false if nothing is left there.
    bool serve(std::size_t n, Time now) {
        Node& node = nodes_[n];
        std::deque<Asked> waited;
        waited.swap(node.waiting);
        for (const Asked& a : waited)
            act(n, a, now);
        std::vector<Asked> due;
        for (const Asked& a : node.coming)
            if (a.at == now)
                due.push_back(a);
        std::erase_if(node.coming, [now](const Asked& a) { return a.at == now; });
        std::sort(due.begin(), due.end(), [](const Asked& a, const Asked& b) {
            return std::pair(a.from, a.order) < std::pair(b.from, b.order);
        });
        for (Asked a : due) {
            if (!a.booked) {
                Time& free = node.bank[a.line % node.bank.size()];
                a.at = std::max(now, free);
                free = a.at + node.level.bank_cycles;
                a.booked = true;
                if (a.at != now) {
                    node.coming.push_back(a);
                    continue;
                }
            }
            act(n, a, now);
        }
        return !node.coming.empty() || !node.waiting.empty();
    }
    void act(std::size_t n, const Asked& a, Time now) {
        Node& node = nodes_[n];
        const bool behind = std::any_of(node.waiting.begin(), node.waiting.end(),
                                        [&](const Asked& w) { return w.line == a.line; });
        const std::size_t value = behind ? refused : touch(n, a.line, a.write, a.write, now, n);
        if (value == refused) {
            node.waiting.push_back(a);
            return;
        }
        ++(a.write ? node.counts.writes : node.counts.reads);
        values_[a.value] = {0, value, true};
    }
    /// Returns the value of when the line is there.
    std::size_t touch(std::size_t n, std::uint64_t line, bool write, bool whole, Time now, std::size_t self) {
        Node& node = nodes_[n];
        std::list<Line>& set = node.sets[line % node.sets.size()];
        const Time done = now + node.level.latency;
        for (auto l = set.begin(); l != set.end(); ++l)
            if (l->number == line) {
                ++node.counts.hits;
                l->dirty |= write;
                set.splice(set.begin(), set, l);
                return make(done, set.front().filled, true);
            }
        std::erase_if(node.mshrs, [&](std::size_t v) { return when(v) <= now; });
        if (!whole && node.level.mshrs != 0 && node.mshrs.size() >= node.level.mshrs)
            return refused;
        ++node.counts.misses;
        if (set.size() == node.level.ways) {
            if (set.back().dirty) {
                ++node.counts.write_backs;
                ask(self, set.back().number, true, done);
            }
            set.pop_back();
        }
        std::size_t filled = make(done, none, true);
        if (!whole) {
            ++node.counts.fills;
            filled = ask(self, line, false, done);
            node.mshrs.push_back(filled);
        }
        set.push_front({line, write, filled});
        return filled;
    }

    Time memory_;
    std::size_t cores_ = 0;
    std::deque<Node> nodes_;
    std::vector<Value> values_;
    std::uint64_t order_ = 0;
};

} // namespace sim::test
