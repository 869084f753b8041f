// Which lines cores share, against a plain account of every byte and copy.
#include "sim/trace/line_sharing.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>
#include <set>

namespace sim::test {
namespace {

using traces::Kind;

/// All copies that cores have of a line, as in caches without end that are kept coherent.
struct Plain {
    std::size_t structure = 0;
    std::set<std::uint32_t> cores, copies;
    std::uint32_t writer = ~0U;
    bool written = false;
    std::map<std::uint64_t, std::set<std::uint32_t>> readers; // of bytes
};

TraceTap::Noted noted(Kind kind, std::uint64_t address, std::uint32_t size, std::uint32_t thread,
                      std::uint16_t structure) {
    TraceTap::Noted n{};
    n.kind = kind;
    n.address = address;
    n.size = size;
    n.stream = thread;
    n.structure = structure;
    return n;
}

TEST(LineSharing, CountsWhatAPlainAccountCounts) {
    for (const int line_bytes : {32, 64, 128}) {
        SCOPED_TRACE(line_bytes);
        Config c;
        c.chip.tiles = 2;
        c.chip.cores = 3;
        c.chip.threads = 2;
        c.l1.line_bytes = line_bytes;
        LineSharing sharing(1000);
        sharing.begin(c, 3);
        sharing.start(0);
        std::mt19937 random(static_cast<unsigned>(line_bytes));
        const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
        const auto width = static_cast<std::uint64_t>(line_bytes),
                   part = std::max<std::uint64_t>(1, width / 64);
        std::map<std::uint64_t, Plain> lines;
        std::uint64_t transfers = 0, invalidations = 0;
        for (int i = 0; i < 20000; ++i) {
            const Kind kind = std::array{Kind::read,   Kind::read,     Kind::read, Kind::write,
                                         Kind::modify, Kind::prefetch, Kind::flush}[below(7)];
            // Some lines are a core's own, some everybody's.
            const std::uint32_t thread = below(12), core = thread / 2;
            const std::uint64_t address = below(3) == 0 ? below(40 * 64) : (core + 1) * 4096 + below(30 * 64);
            const std::uint32_t size = 1 + below(80);
            const auto structure = static_cast<std::uint16_t>(address / 1024 % 2);
            sharing.note(noted(kind, address, size, thread, structure));
            if (kind == Kind::prefetch || kind == Kind::flush)
                continue;
            for (std::uint64_t line = address / width; line <= (address + size - 1) / width; ++line) {
                Plain& l = lines[line];
                if (l.cores.empty())
                    l.structure = structure;
                l.cores.insert(core);
                if (kind != Kind::write)
                    for (std::uint64_t at = std::max(address, line * width);
                         at < std::min(address + size, (line + 1) * width); ++at)
                        l.readers[at / part].insert(core);
                transfers += !l.copies.contains(core) && l.writer != ~0U && l.writer != core ? 1 : 0;
                l.copies.insert(core);
                if (kind == Kind::read)
                    continue;
                invalidations += l.copies.size() - 1;
                l.copies = {core};
                l.writer = core;
                l.written = true;
            }
        }
        std::vector<LineSharing::Structure> expected(3);
        std::vector<LineSharing::Footprint> cores(6);
        for (const auto& [number, l] : lines) {
            LineSharing::Structure& s = expected[l.structure];
            ++s.lines;
            const std::size_t n = l.cores.size();
            s.by_cores.resize(std::max(s.by_cores.size(), n));
            s.written_by.resize(s.by_cores.size());
            ++s.by_cores[n - 1];
            s.written_by[n - 1] += l.written ? 1 : 0;
            s.bytes_read += part * l.readers.size();
            for (const auto& [byte, readers] : l.readers)
                s.bytes_read_by_several += readers.size() > 1 ? part : 0;
            for (const std::uint32_t core : l.cores) {
                ++cores[core].lines;
                cores[core].alone += n == 1 ? 1 : 0;
            }
        }
        const auto found = sharing.structures();
        std::uint64_t moved = 0, dropped = 0;
        for (std::size_t s = 0; s < 3; ++s) {
            EXPECT_EQ(found[s].lines, expected[s].lines);
            EXPECT_EQ(found[s].by_cores, expected[s].by_cores);
            EXPECT_EQ(found[s].written_by, expected[s].written_by);
            EXPECT_EQ(found[s].bytes_read, expected[s].bytes_read);
            EXPECT_EQ(found[s].bytes_read_by_several, expected[s].bytes_read_by_several);
            moved += found[s].transfers;
            dropped += found[s].invalidations;
        }
        EXPECT_EQ(moved, transfers);
        EXPECT_EQ(dropped, invalidations);
        EXPECT_GT(std::min(moved, dropped), 1000U);
        for (std::size_t core = 0; core < 6; ++core) {
            EXPECT_EQ(sharing.footprints()[core].lines, cores[core].lines);
            EXPECT_EQ(sharing.footprints()[core].alone, cores[core].alone);
        }
        // Caches that hold some of what their cores have accessed; L2s are tiles'.
        const auto holds = [](std::uint64_t level, std::uint64_t cache, std::uint64_t address) {
            return (address / 32 * 7 + cache * 3 + level) % 4 != 0;
        };
        EXPECT_FALSE(sharing.due(999));
        EXPECT_TRUE(sharing.due(1000));
        sharing.look(1000, [&](unsigned level, std::uint64_t core, std::uint64_t address) {
            return holds(level, level == 0 ? core : core / 3, address);
        });
        EXPECT_FALSE(sharing.due(1999));
        std::map<std::pair<unsigned, std::size_t>, std::map<std::size_t, std::uint64_t>> held;
        for (const auto& [number, l] : lines)
            for (unsigned level = 0; level < 2; ++level) {
                std::set<std::uint64_t> caches;
                for (const std::uint32_t core : l.cores)
                    if (const std::uint64_t cache = level == 0 ? core : core / 3;
                        holds(level, cache, number * width))
                        caches.insert(cache);
                if (!caches.empty())
                    ++held[{level, l.structure}][caches.size()];
            }
        for (const auto& [where, by] : held)
            for (const auto& [copies, n] : by)
                EXPECT_EQ(sharing.held(where.first, where.second).at(copies - 1), n);
        EXPECT_EQ(sharing.levels(), 2U);
        EXPECT_EQ(held.size(), 4U);
    }
}

} // namespace
} // namespace sim::test
