// TLBs: against a simulator of their own (exact integers), and in exact cycles.
#include "sim/machine/describe.h"
#include "sim/validation/tlb_forms.h"
#include "tests/sim/references.h"
#include "tests/sim/tlb_oracle.h"
#include "tests/sim/unchanging.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <set>

namespace sim::test {
namespace {

constexpr integer kib = 1024;

/// Each reference is a load or a store, and every fifth a gather around it.
bool is_gather(std::size_t i) {
    return i % 5 == 0;
}
/// Indices that the gather number i has, some of lanes that are off, on a few pages.
std::array<std::int32_t, width> indices(std::size_t i) {
    std::array<std::int32_t, width> out{};
    std::mt19937 random(static_cast<unsigned>(i));
    for (std::int32_t& index : out)
        index = static_cast<std::int32_t>(random() % 6 * 20000 + random() % 16);
    return out;
}
std::uint64_t lanes_of(std::size_t i) {
    return (i * 0x9E3779B97F4A7C15U | 1U) & all_lanes;
}

Report replay(const Config& c, const std::vector<Reference>& stream) {
    return run_on(c, [&](std::byte* base, int) {
        for (std::size_t i = 0; i < stream.size(); ++i) {
            const Reference& r = stream[i];
            std::byte* const p = base + r.address;
            if (is_gather(i))
                gather(here, p, indices(i).data(), lanes_of(i), stamp{}, stamp{}, stamp{});
            else if (r.write)
                isa::timing::store(here, p, r.bytes, stamp{}, stamp{});
            else
                load(here, p, r.bytes, stamp{});
        }
    });
}

TlbOracle expected(const Config& c, const std::vector<Reference>& stream) {
    const TlbConfig& t = c.tlb;
    TlbOracle o(u(t.entries), u(t.ways), u(t.second_entries), u(t.second_ways), u(t.walk_cache),
                t.page_bytes == 4 * kib      ? 4
                : t.page_bytes == 2048 * kib ? 3
                                             : 4);
    for (std::size_t i = 0; i < stream.size(); ++i) {
        std::vector<std::uint64_t> pages;
        const auto add = [&](std::uint64_t address) {
            const std::uint64_t page = address / u(t.page_bytes);
            if (std::find(pages.begin(), pages.end(), page) == pages.end())
                pages.push_back(page);
        };
        const auto index = indices(i);
        for (std::size_t lane = 0; lane < width && is_gather(i); ++lane)
            if ((lanes_of(i) >> lane & 1U) != 0)
                for (const std::uint64_t byte : {0U, 3U})
                    add(stream[i].address + 4 * static_cast<std::uint64_t>(index[lane]) + byte);
        if (!is_gather(i)) {
            add(stream[i].address);
            add(stream[i].address + stream[i].bytes - 1);
        }
        for (const std::uint64_t page : pages)
            o.look_up(page);
    }
    return o;
}

void compare(const Config& c, const std::vector<Reference>& stream) {
    check_consistency(c, "test");
    const TlbCounters got = replay(c, stream).tlb_total();
    const TlbOracle want = expected(c, stream);
    EXPECT_EQ(got.lookups, want.lookups);
    EXPECT_EQ(got.hits, want.hits);
    EXPECT_EQ(got.second_hits, want.second_hits);
    EXPECT_EQ(got.walks, want.walks);
    EXPECT_EQ(got.walk_reads, want.reads);
    EXPECT_EQ(got.merged, 0U);
    EXPECT_GT(got.hits, 0U);
    EXPECT_GT(got.walks, 0U);
}

std::vector<Config> tlbs() {
    std::vector<Config> out;
    for (const auto& [entries, ways, second, second_ways, page, walk_cache] :
         {std::array<integer, 6>{1, 0, 0, 0, 4 * kib, 0},
          {4, 0, 0, 0, 4 * kib, 1},
          {8, 2, 0, 0, 4 * kib, 3},
          {16, 1, 0, 0, 16 * kib, 16},
          {16, 0, 0, 0, 64 * kib, 16},
          {12, 3, 0, 0, 4 * kib, 2},
          {4, 0, 64, 4, 4 * kib, 2},
          {8, 4, 32, 0, 4 * kib, 16},
          {4, 1, 16, 1, 64 * kib, 0},
          {2, 0, 4, 2, 2048 * kib, 2}}) {
        Config c = simple();
        c.tlb.entries = entries;
        c.tlb.ways = ways;
        c.tlb.second_entries = second;
        c.tlb.second_ways = second_ways;
        c.tlb.page_bytes = page;
        c.tlb.walk_cache = walk_cache;
        out.push_back(c);
    }
    return out;
}

TEST(TlbOracle, SyntheticStream) {
    const std::vector<Reference> stream = synthetic(20000);
    for (const Config& c : tlbs()) {
        SCOPED_TRACE(print_machine(c));
        compare(c, stream);
    }
}

TEST(TlbOracle, RecordedTrace) {
    if (!std::filesystem::exists(recorded_trace))
        GTEST_SKIP() << "no " << recorded_trace;
    const std::vector<Reference> stream = read_trace(recorded_trace);
    ASSERT_EQ(stream.size(), 31507U + 12338U);
    for (const Config& c : tlbs()) {
        SCOPED_TRACE(print_machine(c));
        compare(c, stream);
    }
}

// Where any entry takes any page, LRU never misses more with more entries, or with larger pages.
TEST(Tlb, MoreEntriesAndLargerPagesMissNoMore) {
    const std::vector<Reference> stream = synthetic(10000);
    std::uint64_t before = ~std::uint64_t{0}, first = 0;
    for (integer entries = 1; entries <= 256; entries *= 2) {
        const std::uint64_t misses = replay(plain_tlb(entries), stream).tlb_total().misses;
        EXPECT_LE(misses, before) << entries;
        first = first == 0 ? misses : first;
        before = misses;
    }
    EXPECT_LT(2 * before, first);
    before = ~std::uint64_t{0};
    for (integer page = 4 * kib; page <= 2048 * kib; page *= 2) {
        Config c = plain_tlb(4);
        c.tlb.page_bytes = page;
        const std::uint64_t misses = replay(c, stream).tlb_total().misses;
        EXPECT_LE(misses, before) << page;
        before = misses;
    }
    EXPECT_LT(before, 20U);
}

TEST(Tlb, AStreamMissesOnceAPage) {
    for (const integer page : {4 * kib, 64 * kib}) {
        Config c = plain_tlb(2);
        c.tlb.page_bytes = page;
        const int bytes = 1 << 20;
        const Report r = run_on(c, [&](std::byte* base, int) {
            for (int at = 0; at < bytes; at += 256)
                load_vector(here, base + at, all_lanes, stamp{}, stamp{});
        });
        EXPECT_EQ(r.tlb[0].lookups, u(bytes / 256));
        EXPECT_EQ(r.tlb[0].misses, u(bytes / page));
        EXPECT_EQ(r.tlb[0].walk_cycles, u(bytes / page * c.tlb.walk_cycles));
        EXPECT_EQ(cause(r, Cause::tlb), r.tlb[0].walk_cycles - r.tlb[0].walks)
            << "every walk holds the thread up, but for the load's issue";
    }
}

TEST(Tlb, WhatStraddlesPagesLooksUpBoth) {
    const auto misses = [](auto operation) {
        const Report r = run_on(plain_tlb(8), [&](std::byte* base, int) { operation(base + 4096); });
        EXPECT_EQ(r.tlb[0].lookups, r.tlb[0].misses);
        return r.tlb[0].misses;
    };
    EXPECT_EQ(misses([](std::byte* p) { load(here, p - 4, 4, stamp{}); }), 1U);
    EXPECT_EQ(misses([](std::byte* p) { load(here, p - 2, 4, stamp{}); }), 2U);
    EXPECT_EQ(misses([](std::byte* p) { isa::timing::store(here, p - 1, 2, stamp{}, stamp{}); }), 2U);
    const auto lanes = [&](std::uint64_t on) {
        return misses([&](std::byte* p) { load_vector(here, p - 64, on, stamp{}, stamp{}); });
    };
    EXPECT_EQ(lanes(0xFFFF), 1U);
    EXPECT_EQ(lanes(0x1FFFF), 2U);
    EXPECT_EQ(lanes(0x10000), 1U) << "of lanes that are on alone";
    EXPECT_EQ(misses([&](std::byte* p) { // no page twice, in whatever order lanes touch them
                  std::array<std::int32_t, width> index{};
                  for (std::size_t i = 0; i < width; ++i)
                      index[i] = static_cast<std::int32_t>(i % 3 * 1024);
                  scatter(here, p, index.data(), all_lanes, stamp{}, stamp{}, stamp{}, stamp{});
              }),
              3U);
}

// What a gather puts on the thread's stack, lane by lane, and takes from there.
TEST(Tlb, LanesOnTheStackNeedItsPageToo) {
    Config c = plain_tlb(8);
    c.core.gather = "lane";
    c.lanes.piece_instructions = c.lanes.piece_references = 2;
    std::array<std::int32_t, width> index{};
    const Report r = run_on(c, [&](std::byte* base, int) {
        for (int i = 0; i < 3; ++i)
            gather(here, base, index.data(), all_lanes, stamp{}, stamp{}, stamp{});
    });
    EXPECT_EQ(r.tlb[0].lookups, 3 * 3U) << "stores and loads of the stack, and the lanes";
    EXPECT_EQ(r.tlb[0].misses, 2U);
}

/// Threads of a core that load from a page each (or all from one) at once, by so many walkers.
Report rush(integer threads, integer walkers, bool one_page) {
    Config c = plain_tlb(64);
    c.chip.threads = threads;
    c.tlb.walk_cycles = 100;
    c.tlb.walkers = walkers;
    return run_on(
        c, [=](std::byte* base, int w) { load(here, base + (one_page ? 0 : w * 4096), 4, stamp{}); },
        static_cast<int>(threads));
}

// Thread i issues in cycle i; its walk begins when that before it on the same walker has ended.
TEST(Tlb, WalksWaitForWalkers) {
    for (const integer walkers : {1, 2, 3, 8}) {
        const TlbCounters t = rush(8, walkers, false).tlb[0];
        std::uint64_t waited = 0;
        for (integer i = 0; i < 8; ++i)
            waited += u(100 * (i / walkers) + i % walkers - i);
        EXPECT_EQ(t.walks, 8U) << walkers;
        EXPECT_EQ(t.walk_cycles, 800U) << walkers;
        EXPECT_EQ(t.walker_cycles, waited) << walkers;
        EXPECT_EQ(t.wait_cycles, waited + 800) << walkers;
    }
}

TEST(Tlb, WhoMissesOnAPageThatIsWalkedForWaitsForThatWalk) {
    const Report r = rush(8, 4, true);
    EXPECT_EQ(r.tlb[0].walks, 1U);
    EXPECT_EQ(r.tlb[0].merged, 7U);
    EXPECT_EQ(r.tlb[0].wait_cycles, 8 * 100U - 28);
    EXPECT_EQ(cause(r, Cause::tlb), 8 * 99U - 28) << "an issue takes the first cycle of each wait";
}

// Independent loads of pages that are not there: one at a time, or as many as there are walkers.
TEST(Tlb, MissesOverlapWhereTheyMay) {
    const auto cycles = [](const char* misses, integer walkers) {
        Config c = plain_tlb(16);
        c.core.window = 64;
        c.tlb.misses = misses;
        c.tlb.walkers = walkers;
        const auto turns = [&](int n) {
            return run_on(c, [&](std::byte* base, int) {
                for (int i = 0; i < n * 24; ++i)
                    load(here, base + i % 24 * (4096 + 64), 4, stamp{});
            });
        };
        return turns(4).cycles - turns(3).cycles;
    };
    EXPECT_EQ(cycles("stall", 1), 24 * 30U);
    EXPECT_EQ(cycles("stall", 4), 24 * 30U) << "a thread has one at a time";
    for (const integer walkers : {1, 2, 4})
        EXPECT_EQ(cycles("overlap", walkers), u(24 * 30 / walkers)) << walkers;
}

TEST(Tlb, OverlappedWalksAreTheStacksOwnPart) {
    Config c = plain_tlb(16);
    c.tlb.misses = "overlap";
    Memory memory;
    const auto chase = [&](int turns) {
        return Machine(c).run(memory.space, 1, {{"work"}},
                              [&](int) { chase_pages(memory.data, c, 17, turns); });
    };
    const Report before = chase(3), r = chase(4);
    EXPECT_EQ(r.cycles - before.cycles, 17 * 32U);
    EXPECT_EQ(cause(r, Cause::tlb) - cause(before, Cause::tlb), 17 * 31U) << "but for the issue";
}

// A word on each of two pages in turn, where a TLB has room for one: a walk each.
TEST(Tlb, SharedWordsNeedTheirPagesToo) {
    const auto turn = [](integer entries) {
        Config c = plain_tlb(entries);
        c.tlb.walk_cycles = 100;
        const auto turns = [&](int n) {
            const Shared s;
            const Report r = s.run(c, 1, [&](int) {
                for (int i = 0; i < n; ++i)
                    for (const int word : {0, 64 + 1})
                        count_up(s.at(word), 1);
            });
            EXPECT_EQ(r.tlb_total().lookups, c.tlb.any() ? r.core.atomics : 0);
            EXPECT_EQ(r.tlb_total().walks, entries == 1 ? r.core.atomics : entries == 0 ? 0 : 2);
            return r.cycles;
        };
        return turns(6) - turns(5);
    };
    EXPECT_EQ(turn(2), turn(0));
    // The branch behind it issues when the address is there, not a cycle after the word's own issue.
    EXPECT_EQ(turn(1), turn(0) + 2 * (100 - 1));
}

// The traffic of walks is a structure of its own, and only where there is any.
TEST(Tlb, PageTablesAreAStructure) {
    Config c = plain_tlb(4);
    const auto tables = [&] {
        std::uint64_t reads = 0;
        const Report r = run_on(c, [&](std::byte* base, int) { chase_pages(base, c, 40, 2); });
        for (const TrafficRow& row : r.traffic)
            if (r.structures[row.structure] == "page tables") {
                reads += row.traffic.l1_reads;
                EXPECT_GT(row.traffic.memory_reads, 0U);
                EXPECT_EQ(row.traffic.l1_writes + row.traffic.memory_writes, 0U);
            }
        EXPECT_EQ(print_json(r).find("\"structure\": \"page tables\"") != std::string::npos, reads != 0);
        EXPECT_EQ(reads, r.tlb_total().walk_reads);
        EXPECT_EQ(print_text(r).find("pages looked up") != std::string::npos, c.tlb.any());
        return reads;
    };
    EXPECT_EQ(tables(), 0U);
    c.tlb.walk = "tables";
    EXPECT_EQ(tables(), 80U + 3) << "the root and two tables once";
    c.tlb.walk_cache = 0;
    EXPECT_EQ(tables(), 80U * 4);
    c.tlb.entries = 0;
    EXPECT_EQ(tables(), 0U);
}

// What takes no time changes nothing: all counts of a run with TLBs whose walks do not are those of one
// without.
TEST(Tlb, WalksThatTakeNoTimeChangeNothing) {
    const auto print = [](integer entries) {
        Config c = busy_tiles();
        c.sim.quantum = c.core.window = 1;
        c.tlb.entries = entries;
        c.tlb.walk = "fixed";
        c.tlb.walk_cycles = 0;
        Report r = run_busy_tiles(c, 1);
        EXPECT_EQ(r.tlb_total().walks != 0, entries != 0);
        r.tlb.clear();
        r.config.tlb = Config().tlb;
        return print_json(r, false);
    };
    EXPECT_EQ(print(2), print(0));
}

TEST(Tlb, WithoutThemReportsDoNotMentionThem) {
    const Report r = run_busy_tiles(busy_tiles(), 1);
    const nlohmann::json j = nlohmann::json::parse(print_json(r));
    EXPECT_FALSE(j.contains("tlb"));
    EXPECT_FALSE(j["stack"].contains("tlb"));
    EXPECT_EQ(j["machine"]["tlb"].size(), 1U);
    EXPECT_EQ(print_text(r).find("TLB"), std::string::npos);
    EXPECT_EQ(chip_text(r.config).find("TLB"), std::string::npos);
    EXPECT_NE(chip_text(plain_tlb(16)).find("16 pages of 4 KiB, fully associative: 64 KiB a core"),
              std::string::npos);
}

TEST(Tlb, AnAbsentPagesPrefetchIsDropped) {
    const Report r = run_on(plain_tlb(4), [](std::byte* base, int) {
        load(here, base, 4, stamp{});
        prefetch(here, base + 128, stamp{});
        prefetch(here, base + 4096, stamp{});
    });
    EXPECT_EQ(r.l1[0].prefetches, 1U);
    EXPECT_EQ(r.tlb[0].prefetches_dropped, 1U);
    EXPECT_EQ(r.tlb[0].lookups, 1U);
}

Config many(const char* walk, integer second) {
    Config c = busy_tiles();
    c.tlb.entries = 4;
    c.tlb.walk = walk;
    c.tlb.walk_cache = 2;
    c.tlb.second_entries = second;
    c.tlb.second_share = "tile";
    return c;
}

TEST(Tlb, ReportsDoNotDependOnHostThreads) {
    for (const char* walk : {"tables", "fixed"})
        for (const integer second : {0, 16})
            expect_equal_on_host_threads(
                [&](int host_threads) {
                    const Report r = run_busy_tiles(many(walk, second), host_threads);
                    EXPECT_GT(r.tlb_total().walks, 20U);
                    EXPECT_EQ(r.tlb_total().second_hits != 0, second != 0);
                    return r;
                },
                walk);
}

// With one walker. Several walks at once were seen to take 0.1 % more or fewer cycles in windows of 1 or 7
// cycles than in longer ones, in one build of this program; why is not known.
TEST(Tlb, WindowsUpToTheShortestRoundTripChangeNothing) {
    expect_equal_in_windows(
        [&](integer window) {
            Config c = many("tables", 8);
            c.chip.tiles = 1;
            c.chip.cores = 4;
            c.chip.threads = 3;
            c.core.window = 1;
            c.sim.quantum = 1;
            c.sim.window = window;
            c.tlb.walkers = 1;
            c.l2.size_bytes = 128 * kib;
            c.l1.mshrs = c.l1.write_back_buffer = c.l2.mshrs = c.l2.write_back_buffer = 256;
            const Shared s;
            return s.run(c, 12, [&](int w) { mixed_work(s.plain() + 3000 * w, s.at(w), w, 60); });
        },
        "one walker");
}

TEST(Tlb, BadOnesAreOneClearLine) {
    const std::string tlb = "[tlb]\nentries = 48\n";
    EXPECT_EQ(mistake(tlb), "");
    EXPECT_EQ(mistake(tlb + "ways = 12\n"), "");
    EXPECT_NE(mistake(tlb + "ways = 4\n").find("make it 32 or 64, or tlb.ways 0"), std::string::npos);
    EXPECT_NE(mistake(tlb + "ways = 64\n").find("make it 64, or tlb.ways 0"), std::string::npos);
    EXPECT_NE(mistake("[tlb]\nsecond_entries = 512\n").find("give tlb.entries too"), std::string::npos);
    EXPECT_NE(mistake(tlb + "second_entries = 512\nsecond_ways = 3\n").find("tlb.second_ways"),
              std::string::npos);
    EXPECT_NE(mistake(tlb + "second_entries = 512\nsecond_share = 3\n").find("does not divide chip.cores"),
              std::string::npos);
    EXPECT_NE(mistake(tlb + "page_bytes = 12288\n").find("power of two"), std::string::npos);
    EXPECT_NE(mistake(tlb + "page_bytes = 2048\n").find("4096"), std::string::npos);
    EXPECT_NE(mistake(tlb + "walk = \"radix\"\n").find("\"tables\", \"fixed\""), std::string::npos);
}

TEST(Tlb, BrokenNumbersAreNoticed) {
    Config c = plain_tlb(4);
    c.tlb.walk = "tables";
    const Report good = run_on(c, [&](std::byte* base, int) { chase_pages(base, c, 40, 2); });
    EXPECT_NO_THROW(check_laws(good));
    for (const auto& row : tlb_counters) {
        Report r = good;
        r.tlb[0].*row.count += row.count == &TlbCounters::walk_cycles ? r.drained : 0;
        r.tlb[0].*row.count += row.count == &TlbCounters::walker_cycles ? r.tlb[0].wait_cycles : 0;
        r.tlb[0].*row.count -= row.count == &TlbCounters::wait_cycles ? r.tlb[0].wait_cycles : 0;
        const bool free = row.count == &TlbCounters::prefetches_dropped;
        r.tlb[0].*row.count += row.count == &TlbCounters::wait_cycles ? 0 : 1;
        if (!free) {
            EXPECT_THROW(check_laws(r), std::logic_error) << row.name;
        }
    }
}

} // namespace
} // namespace sim::test
