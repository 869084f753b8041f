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
        bool through = false, around = false; // write policy
        std::uint64_t ahead = 0;              // lines that a tagged next-line prefetcher asks for
    };
    explicit CacheOracle(const Kind& kind)
        : kind_(kind), sets_(kind.size_bytes / kind.ways / kind.line_bytes, Set(kind.ways)) {}

    std::uint64_t accesses = 0, hits = 0, misses = 0, fills = 0, write_backs = 0;
    std::uint64_t written_through = 0, written_around = 0, prefetches = 0, used = 0;
    std::uint64_t compulsory = 0, capacity = 0, conflict = 0;
    std::vector<OracleRequest> out; // what it asks of the next level

    /// Some bytes within one line.
    void access(std::uint64_t address, bool write, std::uint32_t bytes) {
        ++accesses;
        const std::uint64_t line = address / kind_.line_bytes;
        const bool no_line = write && kind_.around;
        ++now_;
        bool ask_ahead = false;
        Way* there = find(line);
        if (there != nullptr) {
            ++hits;
            there->used = now_;
            there->distance = 0;
            there->dirty |= write && !kind_.through;
            ask_ahead = there->prefetched;
            used += there->prefetched ? 1 : 0;
            there->prefetched = false;
            point_away(line, *there);
        } else {
            ++misses;
            ++(seen_.count(line) == 0 ? compulsory : in_other(line) ? conflict : capacity);
            if (!no_line) {
                bring(line, write && bytes == kind_.line_bytes, write && !kind_.through);
                ask_ahead = true;
            } else {
                ++written_around;
            }
        }
        if (write && (kind_.through || (there == nullptr && kind_.around))) {
            ++written_through;
            out.push_back({address, bytes, true});
        }
        note_in_other(line, !no_line);
        for (std::uint64_t next = line + 1; ask_ahead && next <= line + kind_.ahead; ++next)
            if (find(next) == nullptr) {
                ++prefetches;
                ++now_;
                bring(next, false, false);
                find(next)->prefetched = true;
                note_in_other(next, true);
            }
    }

private:
    struct Way {
        std::uint64_t line = 0;
        bool valid = false, dirty = false, prefetched = false;
        std::uint64_t used = 0;
        int distance = 3;
    };
    struct Set {
        explicit Set(std::size_t n) : ways(n) {}
        std::vector<Way> ways;
        std::map<std::pair<std::size_t, std::size_t>, bool> second; // of [begin, size): the half to look in
    };

    Way* find(std::uint64_t line) {
        for (Way& w : sets_[line % sets_.size()].ways)
            if (w.valid && w.line == line)
                return &w;
        return nullptr;
    }
    void bring(std::uint64_t line, bool whole, bool dirty) {
        Set& set = sets_[line % sets_.size()];
        Way& way = set.ways[make_room(set)];
        if (!whole) {
            ++fills;
            out.push_back({line * kind_.line_bytes, static_cast<std::uint32_t>(kind_.line_bytes), false});
        }
        way = {line, true, dirty, false, now_, 2};
        point_away(line, way);
    }
    /// The fully associative cache of the same size: lines, last used first.
    bool in_other(std::uint64_t line) const { return where_.count(line) != 0; }
    void note_in_other(std::uint64_t line, bool allocate) {
        seen_.insert(line);
        auto found = where_.find(line);
        if (found != where_.end()) {
            other_.splice(other_.begin(), other_, found->second);
            return;
        }
        if (!allocate)
            return;
        if (other_.size() == kind_.size_bytes / kind_.line_bytes) {
            where_.erase(other_.back());
            other_.pop_back();
        }
        other_.push_front(line);
        where_[line] = other_.begin();
    }
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
    void point_away(std::uint64_t line, const Way& used) {
        Set& set = sets_[line % sets_.size()];
        const auto way = static_cast<std::size_t>(&used - set.ways.data());
        std::size_t begin = 0;
        for (std::size_t size = set.ways.size(); size > 1; size /= 2) {
            const bool in_second = way >= begin + size / 2;
            set.second[{begin, size}] = !in_second;
            begin += in_second ? size / 2 : 0;
        }
    }

    Kind kind_;
    std::vector<Set> sets_;
    std::set<std::uint64_t> seen_;
    std::list<std::uint64_t> other_;
    std::map<std::uint64_t, std::list<std::uint64_t>::iterator> where_;
    std::uint64_t now_ = 0, random_ = 0x9E3779B97F4A7C15U;
};

} // namespace sim::test
