// A cache simulator of its own to compare with: sets of ways, what replacement says, no time; semantics as of
// Dinero IV. Written for the tests alone, as simply as can be and in no way like sim/memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <list>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace sim::test {

/// A request to the level below: a line, or (written through) some bytes of one.
struct OracleRequest {
    std::uint64_t address;
    std::uint32_t bytes;
    bool write;
    bool operator==(const OracleRequest&) const = default;
};

class CacheOracle {
public:
    struct Kind {
        std::uint64_t size_bytes, ways, line_bytes;
        std::string replacement = "lru";
    };
    explicit CacheOracle(const Kind& kind)
        : kind_(kind), sets_(kind.size_bytes / kind.ways / kind.line_bytes, Set(kind.ways)) {}

    std::uint64_t accesses = 0, hits = 0, misses = 0, fills = 0, write_backs = 0;
    std::vector<OracleRequest> out; // what it asks of the next level

    /// Within one line. `whole`: all of the line is written, it need not be read.
    void access(std::uint64_t address, bool write, bool whole = false) {
        ++accesses;
        const std::uint64_t line = address / kind_.line_bytes;
        Set& set = sets_[line % sets_.size()];
        ++now_;
        for (std::size_t w = 0; w < set.ways.size(); ++w)
            if (set.ways[w].valid && set.ways[w].line == line) {
                ++hits;
                set.ways[w].used = now_;
                set.ways[w].distance = 0;
                set.ways[w].dirty |= write;
                point_away(set, w);
                return;
            }
        ++misses;
        const std::size_t w = make_room(set);
        if (!whole) {
            ++fills;
            out.push_back({line * kind_.line_bytes, static_cast<std::uint32_t>(kind_.line_bytes), false});
        }
        set.ways[w] = {line, true, write, now_, 2};
        point_away(set, w);
    }

private:
    struct Way {
        std::uint64_t line = 0;
        bool valid = false, dirty = false;
        std::uint64_t used = 0;
        int distance = 3;
    };
    struct Set {
        explicit Set(std::size_t n) : ways(n) {}
        std::vector<Way> ways;
        std::map<std::pair<std::size_t, std::size_t>, bool> second; // of [begin, size): the half to look in
    };

    std::size_t make_room(Set& set) {
        for (std::size_t w = 0; w < set.ways.size(); ++w)
            if (!set.ways[w].valid)
                return w;
        const std::size_t w = choose(set);
        if (set.ways[w].dirty) {
            ++write_backs;
            out.push_back(
                {set.ways[w].line * kind_.line_bytes, static_cast<std::uint32_t>(kind_.line_bytes), true});
        }
        return w;
    }
    std::size_t choose(Set& set) {
        if (kind_.replacement == "lru") {
            auto older = [](const Way& a, const Way& b) { return a.used < b.used; };
            return at(set, std::min_element(set.ways.begin(), set.ways.end(), older));
        }
        if (kind_.replacement == "srrip")
            for (;;) {
                auto far = std::find_if(set.ways.begin(), set.ways.end(),
                                        [](const Way& w) { return w.distance == 3; });
                if (far != set.ways.end())
                    return at(set, far);
                for (Way& w : set.ways)
                    ++w.distance;
            }
        if (kind_.replacement == "random") {
            const std::size_t w = ((random_ >> 32U) * set.ways.size()) >> 32U;
            random_ ^= random_ << 13U;
            random_ ^= random_ >> 7U;
            random_ ^= random_ << 17U;
            return w;
        }
        std::size_t begin = 0;
        for (std::size_t size = set.ways.size(); size > 1; size /= 2)
            begin += set.second[{begin, size}] ? size / 2 : 0;
        return begin;
    }
    static std::size_t at(Set& set, std::vector<Way>::iterator w) {
        return static_cast<std::size_t>(w - set.ways.begin());
    }
    static void point_away(Set& set, std::size_t way) {
        std::size_t begin = 0;
        for (std::size_t size = set.ways.size(); size > 1; size /= 2) {
            const bool in_second = way >= begin + size / 2;
            set.second[{begin, size}] = !in_second;
            begin += in_second ? size / 2 : 0;
        }
    }

    Kind kind_;
    std::vector<Set> sets_;
    std::uint64_t now_ = 0, random_ = 0x9E3779B97F4A7C15U;
};

} // namespace sim::test
