// Several levels of caches to compare with: lists of lines, least recently used last, no time. Levels are
// shared by groups of cores; each is inclusive, exclusive or neither; what lies beyond the tiles hears of an
// access when it is over. Write-back, write-allocate. Written for the tests alone, in no way like sim/memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <list>
#include <string>
#include <vector>

namespace sim::test {

class HierarchyOracle {
public:
    struct Level {
        std::uint64_t size_bytes, ways, line_bytes, sharing; // cores of one
        std::string inclusion;
        bool beyond;
    };
    struct Counts {
        std::uint64_t reads = 0, writes = 0, hits = 0, misses = 0, fills = 0, write_backs = 0,
                      clean_victims = 0, back_invalidations = 0, moved_up = 0;
    };

    HierarchyOracle(const std::vector<Level>& levels, std::uint64_t cores) : levels_(levels) {
        for (const Level& l : levels) {
            caches_.emplace_back();
            for (std::uint64_t core = 0; core < cores; core += l.sharing)
                caches_.back().push_back(
                    {{}, std::vector<std::list<Line>>(l.size_bytes / l.ways / l.line_bytes)});
        }
    }
    void access(std::uint64_t core, std::uint64_t address, bool write) {
        touch(0, core, address, write, false, 1);
        while (!later_.empty()) {
            const Later l = later_.front();
            later_.pop_front();
            touch(l.level, l.core, l.address, l.write, false, l.bytes);
        }
    }
    const Counts& counts(std::size_t level, std::size_t cache) const { return caches_[level][cache].counts; }
    std::size_t caches(std::size_t level) const { return caches_[level].size(); }

    std::uint64_t memory_reads = 0, memory_writes = 0;

private:
    struct Line {
        std::uint64_t number;
        bool dirty;
    };
    struct Cache {
        Counts counts;
        std::vector<std::list<Line>> sets;
    };
    struct Later {
        std::size_t level;
        std::uint64_t core, address, bytes;
        bool write;
    };

    Cache& at(std::size_t level, std::uint64_t core) { return caches_[level][core / levels_[level].sharing]; }
    std::list<Line>& set(std::size_t level, std::uint64_t core, std::uint64_t number) {
        auto& sets = at(level, core).sets;
        return sets[number % sets.size()];
    }
    static std::list<Line>::iterator find(std::list<Line>& set, std::uint64_t number) {
        return std::find_if(set.begin(), set.end(), [&](const Line& l) { return l.number == number; });
    }
    bool is(std::size_t level, const char* inclusion) const {
        return level > 0 && level < levels_.size() && levels_[level].inclusion == inclusion;
    }

    /// Returns whether the line comes dirty.
    bool ask_below(std::size_t level, std::uint64_t core, std::uint64_t address, bool write, bool clean) {
        const std::uint64_t bytes = levels_[level].line_bytes;
        if (level + 1 == levels_.size()) {
            ++(write ? memory_writes : memory_reads);
            return false;
        }
        if (levels_[level + 1].beyond) {
            later_.push_back({level + 1, core, address, bytes, write});
            return false;
        }
        return touch(level + 1, core, address, write, clean, bytes);
    }
    /// An access of so many bytes; returns whether what was read is dirty and goes up.
    bool touch(std::size_t level, std::uint64_t core, std::uint64_t address, bool write, bool clean,
               std::uint64_t bytes) {
        const std::uint64_t number = address / levels_[level].line_bytes;
        Counts& counts = at(level, core).counts;
        std::list<Line>& lines = set(level, core, number);
        ++(write ? counts.writes : counts.reads);
        auto there = find(lines, number);
        ++(there != lines.end() ? counts.hits : counts.misses);
        if (is(level, "exclusive") && !write) {
            if (there == lines.end()) {
                ++counts.fills;
                return ask_below(level, core, address, false, false);
            }
            const bool dirty = there->dirty;
            lines.erase(there);
            ++counts.moved_up;
            return dirty;
        }
        if (there != lines.end())
            lines.splice(lines.begin(), lines, there);
        else
            bring(level, core, number, !(write && bytes == levels_[level].line_bytes && level > 0));
        if (write && !clean)
            find(lines, number)->dirty = true;
        return false;
    }
    void bring(std::size_t level, std::uint64_t core, std::uint64_t number, bool read) {
        Counts& counts = at(level, core).counts;
        std::list<Line>& lines = set(level, core, number);
        const std::uint64_t line_bytes = levels_[level].line_bytes;
        const bool evicts = lines.size() == levels_[level].ways;
        const std::uint64_t victim = evicts ? lines.back().number : 0;
        const bool swaps = is(level + 1, "exclusive");
        auto send = [&] {
            Line& l = *find(lines, victim);
            ++(l.dirty ? counts.write_backs : counts.clean_victims);
            const bool clean = !l.dirty;
            l.dirty = false;
            ask_below(level, core, victim * line_bytes, true, clean);
        };
        if (evicts && is(level, "inclusive"))
            lines.back().dirty |= recall(level, core, victim * line_bytes);
        if (evicts && (swaps ? !read : lines.back().dirty))
            send();
        bool dirty = false;
        if (read) {
            ++counts.fills;
            dirty = ask_below(level, core, number * line_bytes, false, false);
            if (evicts && swaps && find(lines, victim) != lines.end())
                send();
        }
        if (auto gone = find(lines, victim); evicts && gone != lines.end())
            lines.erase(gone);
        lines.push_front({number, dirty});
    }
    /// Takes a line away from all caches above one; returns whether it was dirty anywhere.
    bool recall(std::size_t level, std::uint64_t core, std::uint64_t address) {
        const std::uint64_t group = core / levels_[level].sharing * levels_[level].sharing;
        bool dirty = false;
        for (std::size_t upper = 0; upper < level; ++upper)
            for (std::uint64_t c = group; c < group + levels_[level].sharing; c += levels_[upper].sharing)
                for (std::uint64_t a = address; a < address + levels_[level].line_bytes;
                     a += levels_[upper].line_bytes) {
                    std::list<Line>& lines = set(upper, c, a / levels_[upper].line_bytes);
                    auto there = find(lines, a / levels_[upper].line_bytes);
                    if (there == lines.end())
                        continue;
                    dirty |= there->dirty;
                    ++at(upper, c).counts.back_invalidations;
                    lines.erase(there);
                }
        return dirty;
    }

    std::vector<Level> levels_;
    std::vector<std::vector<Cache>> caches_;
    std::deque<Later> later_;
};

} // namespace sim::test
