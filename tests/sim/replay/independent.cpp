// Replays beside the tests' own simple caches, which know no time: the same counts at every level, of long
// streams made here and of a real program's trace.
#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "sim/replay/timed_replay.h"
#include "tests/sim/hierarchy_oracle.h"
#include "traces/block_builder.h"
#include "traces/error.h"
#include "traces/formats/format.h"
#include "traces/in_order.h"
#include "traces/io/interrupt.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <random>

namespace sim {
namespace {

using test::HierarchyOracle;

/// Two levels of caches, of two cores each, LRU; and three.
struct Hierarchy {
    std::vector<std::string> settings;
    std::vector<HierarchyOracle::Level> levels;
};
const std::vector<Hierarchy> hierarchies = {
    {{"l1.size_bytes=16384", "l1.ways=4", "l1.line_bytes=64", "l2.size_bytes=131072", "l2.ways=8",
      "l2.line_bytes=64"},
     {{16384, 4, 64, 1, "", false}, {131072, 8, 64, 2, "none", false}}},
    {{"l1.size_bytes=8192", "l1.ways=2", "l1.line_bytes=32", "l2.size_bytes=65536", "l2.ways=16",
      "l2.line_bytes=128", "l2.inclusion=inclusive"},
     {{8192, 2, 32, 1, "", false}, {65536, 16, 128, 2, "inclusive", false}}},
    {{"l1.size_bytes=16384", "l1.ways=4", "l1.line_bytes=64", "l2.size_bytes=32768", "l2.ways=8",
      "l2.line_bytes=64", "l2.inclusion=exclusive", "l2.share=1", "l3.size_bytes=262144", "l3.ways=16",
      "l3.share=tile"},
     {{16384, 4, 64, 1, "", false},
      {32768, 8, 64, 1, "exclusive", false},
      {262144, 16, 64, 2, "none", false}}},
};

Config machine(const Hierarchy& h) {
    std::vector<std::string> settings = h.settings;
    settings.insert(settings.end(), {"chip.tiles=1", "chip.cores=2", "chip.threads=1"});
    return read_machine(RAZOR_SOURCE_DIR "/configs/machines/tiny.toml", settings);
}

void access_lines(HierarchyOracle& oracle, std::uint64_t line_bytes, std::uint64_t core,
                  std::uint64_t address, std::uint64_t bytes, bool write) {
    for (std::uint64_t at = address; at < address + bytes; at = (at | (line_bytes - 1)) + 1)
        oracle.access(core, at, write);
}

void expect_equal(const Report& r, const HierarchyOracle& oracle) {
    for (unsigned level = 0; level < r.config.cache_levels(); ++level)
        for (std::size_t c = 0; c < oracle.caches(level); ++c) {
            SCOPED_TRACE("level " + std::to_string(level) + ", cache " + std::to_string(c));
            const CacheCounters& got = r.caches(level).at(c);
            const HierarchyOracle::Counts& expected = oracle.counts(level, c);
            EXPECT_EQ(got.reads, expected.reads);
            EXPECT_EQ(got.writes, expected.writes);
            EXPECT_EQ(got.hits, expected.hits);
            EXPECT_EQ(got.misses, expected.misses);
            EXPECT_EQ(got.fills, expected.fills);
            EXPECT_EQ(got.write_backs, expected.write_backs);
            EXPECT_EQ(got.clean_victims, expected.clean_victims);
            EXPECT_EQ(got.back_invalidations, expected.back_invalidations);
            EXPECT_EQ(got.moved_up, expected.moved_up);
        }
    EXPECT_EQ(r.memory.reads, oracle.memory_reads);
    EXPECT_EQ(r.memory.writes, oracle.memory_writes);
}

/// Structures and phases sum to what the caches say.
void expect_sums(const Report& r) {
    for (unsigned level = 0; level < r.config.cache_levels(); ++level) {
        std::uint64_t accesses = 0, misses = 0, write_backs = 0;
        for (const TrafficRow& t : r.traffic) {
            accesses += t.traffic.*traffic_of_level[level].reads + t.traffic.*traffic_of_level[level].writes;
            misses += t.traffic.*traffic_of_level[level].misses;
            write_backs += t.traffic.*traffic_of_level[level].write_backs;
        }
        const CacheCounters all = r.cache_total(level);
        EXPECT_EQ(accesses, all.reads + all.writes);
        EXPECT_EQ(accesses, all.hits + all.misses);
        EXPECT_EQ(misses, all.misses);
        EXPECT_EQ(write_backs, all.write_backs);
    }
    std::uint64_t reads = 0, writes = 0;
    for (const TrafficRow& t : r.traffic) {
        reads += t.traffic.memory_reads;
        writes += t.traffic.memory_writes;
    }
    EXPECT_EQ(reads, r.memory.reads);
    EXPECT_EQ(writes, r.memory.writes);
}

traces::Description description(const char* time) {
    traces::Description d;
    d.time = time;
    d.structures = {"rows", "heap", "stack"};
    d.phases = {"first", "second"};
    return d;
}

/// References of two streams in a row: mostly near what was used before, now and then anywhere, in a row, or
/// as far up as programs have their stacks; some across lines.
struct Synthetic {
    std::mt19937_64 random{5};
    std::uint64_t time = 7'000'000'000;
    std::array<std::uint64_t, 2> at{}, region{};

    void make_block(std::size_t count, traces::Block& block);
};
void Synthetic::make_block(std::size_t count, traces::Block& block) {
    traces::BlockBuilder builder;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t stream = random() % 4 == 0 ? 1 : 0;
        const std::uint64_t dice = random() % 100;
        if (dice < 2)
            region[stream] = random() % 8 * 32768 + (random() % 16 == 0 ? 0x7ffe00000000U : 0);
        at[stream] = dice < 40 ? at[stream] + 8 : region[stream] + random() % (dice < 90 ? 4096U : 262144U);
        traces::Reference r{time += random() % 3, at[stream], stream, {}};
        r.what.size = random() % 50 == 0 ? 40 : 4;
        r.what.kind = dice % 3 == 0 ? traces::Kind::write : traces::Kind::read;
        r.what.structure = static_cast<std::uint16_t>(random() % 3);
        r.what.phase = static_cast<std::uint16_t>(i * 2 / count);
        builder.add(r);
    }
    builder.take(block);
}

TEST(IndependentReplay, TenMillionReferencesCountAsInSimpleCaches) {
    for (const Hierarchy& h : hierarchies)
        for (const char* time : {"cycles", "order"}) {
            if (time[0] == 'o' && &h != &hierarchies.front())
                continue;
            SCOPED_TRACE(std::string(time) + ", " + std::to_string(&h - hierarchies.data()));
            const Config config = machine(h);
            HierarchyOracle oracle(h.levels, 2);
            Replay replay(config, description(time), {});
            Synthetic synthetic;
            const std::size_t blocks = &h == &hierarchies.front() && time[0] == 'c' ? 40 : 4;
            for (std::size_t b = 0; b < blocks; ++b) {
                traces::Block block;
                synthetic.make_block(250'000, block);
                replay.add(block);
                traces::each_in_order(
                    block,
                    [&](const traces::Segment& s, std::size_t i) {
                        access_lines(oracle, h.levels[0].line_bytes, s.stream, block.addresses[i],
                                     block.what(i).size, block.what(i).kind == traces::Kind::write);
                    },
                    [](const traces::Turn&) {});
            }
            const ReplayResult result = replay.finish(description(time));
            EXPECT_EQ(result.references, blocks * 250'000);
            EXPECT_FALSE(result.windows);
            EXPECT_GT(result.report.l1_total().misses, 10'000U);
            EXPECT_GT(result.report.l2_total().write_backs, 1000U);
            expect_equal(result.report, oracle);
            expect_sums(result.report);
        }
}

TEST(IndependentReplay, AProgramsTraceCountsAsInSimpleCaches) {
    const std::string file = RAZOR_SHARED_SCENES "/traces/simple_app.din.gz";
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "skipped: there is no " << file;
    for (const Hierarchy& h : hierarchies)
        for (const bool fetches : {false, true}) {
            const auto input = traces::read_din(traces::open_source(file));
            HierarchyOracle oracle(h.levels, 2);
            Replay replay(machine(h), input->description(), {fetches});
            std::uint64_t fetched = 0;
            for (traces::Block block; input->next(block);) {
                replay.add(block);
                traces::each_in_order(
                    block,
                    [&](const traces::Segment& s, std::size_t i) {
                        const traces::Class& c = block.what(i);
                        fetched += c.kind == traces::Kind::fetch ? 1 : 0;
                        if (c.kind != traces::Kind::fetch || fetches)
                            access_lines(oracle, h.levels[0].line_bytes, s.stream, block.addresses[i],
                                         std::max(c.size, 1U), c.kind == traces::Kind::write);
                    },
                    [](const traces::Turn&) {});
            }
            const ReplayResult result = replay.finish(input->description());
            EXPECT_EQ(result.left_out[static_cast<std::size_t>(traces::Kind::fetch)], fetches ? 0 : fetched);
            EXPECT_GT(fetched, 1000U);
            EXPECT_GT(result.report.l1_total().misses, 1000U);
            expect_equal(result.report, oracle);
            expect_sums(result.report);
        }
}

/// Requests for memory of another tool, far apart and all over 64 bits of addresses: each is served by
/// itself, at its clock.
TEST(IndependentReplay, RequestsOfMemoryComeAtItsClocks) {
    constexpr std::uint64_t count = 3000, apart = 5000, first = 70000;
    std::string text;
    for (std::uint64_t i = 0; i < count; ++i)
        text += fmt::format("0x{:X} {} {}\n", i * 0x0123456789ABCDC0U, i % 3 == 0 ? "WRITE" : "READ",
                            first + i * apart);
    const auto input = traces::read_dramsim3(traces::memory_source(text, "sample"));
    Config config = machine(hierarchies.front());
    for (const char* controller : {"immediate", "queued"}) {
        SCOPED_TRACE(controller);
        config.memory.controller = controller;
        Replay replay(config, input->description(), {});
        const auto again = traces::read_dramsim3(traces::memory_source(text, "sample"));
        for (traces::Block block; again->next(block);)
            replay.add(block);
        const Report r = replay.finish(again->description()).report;
        EXPECT_EQ(r.memory.reads, count - count / 3);
        EXPECT_EQ(r.memory.writes, count / 3);
        EXPECT_NEAR(static_cast<double>(r.memory.last_clock), static_cast<double>((count - 1) * apart), 500);
        std::uint64_t reads = 0;
        for (const TrafficRow& row : r.traffic)
            reads += row.traffic.memory_reads;
        EXPECT_EQ(reads, r.memory.reads);
    }
}

/// Times that go back are no mistake: such a request comes when it can.
TEST(IndependentReplay, RequestsOfMemoryMayComeInAnyOrder) {
    std::string text;
    std::mt19937 random(3);
    for (std::uint64_t i = 0; i < 5000; ++i)
        text += fmt::format("0x{:X} {} {}\n", random() & ~63U, i % 3 == 0 ? "WRITE" : "READ",
                            random() % 10'000'000);
    Config config = machine(hierarchies.front());
    for (const char* controller : {"immediate", "queued"}) {
        config.memory.controller = controller;
        const auto input = traces::read_dramsim3(traces::memory_source(text, "sample"));
        Replay replay(config, input->description(), {});
        for (traces::Block block; input->next(block);)
            replay.add(block);
        const Report r = replay.finish(input->description()).report;
        EXPECT_EQ(r.memory.reads + r.memory.writes, 5000U) << controller;
    }
}

/// What a machine or a trace does not have is an error in a line that says what to do.
TEST(IndependentReplay, WhatCannotBeReplayedIsSaid) {
    const auto mistake = [](const std::function<void()>& act) -> std::string {
        try {
            act();
        } catch (const traces::Error& e) {
            return e.what();
        } catch (const ConfigError& e) {
            return e.what();
        }
        return "";
    };
    const Config config = machine(hierarchies.front());
    traces::BlockBuilder builder;
    builder.add({0, 0, 2, {}});
    traces::Block block;
    builder.take(block);
    EXPECT_NE(mistake([&] { Replay(config, description("order"), {}).add(block); }).find("chip.threads"),
              std::string::npos);
    traces::Description dram = description("order");
    dram.level = "dram";
    EXPECT_NE(mistake([&] { Replay(config, dram, {}).add(block); }).find("chip.tiles"), std::string::npos);
    dram.level = "l7";
    EXPECT_NE(mistake([&] { Replay(config, dram, {}); }).find("level core"), std::string::npos);
    Config reference = config;
    reference.sim.mode = "reference";
    EXPECT_NE(
        mistake([&] { TimedReplay(reference, nullptr, description("order"), {}); }).find("sim.mode=fast"),
        std::string::npos);
    // What an L1 passes on says how; else nobody knows what the levels below were asked.
    traces::Description passed = description("cycles");
    passed.level = "l1";
    builder.add({0, 0, 0, {}});
    builder.take(block);
    EXPECT_NE(mistake([&] { Replay(config, passed, {}).add(block); }).find("record it again"),
              std::string::npos);
    EXPECT_NE(mistake([&] { TimedReplay(config, nullptr, passed, {}); }).find("level core"),
              std::string::npos);
    builder.add({0, 0, 2, {}});
    builder.take(block);
    EXPECT_NE(mistake([&] { Replay(config, passed, {}).add(block); }).find("of an L1 with number 2"),
              std::string::npos);
    for (std::uint64_t i = 0; i < 1100; ++i)
        builder.add({i, i << 40U, 0, {}});
    builder.take(block);
    EXPECT_NE(mistake([&] { Replay(config, description("order"), {}).add(block); }).find("256 MiB"),
              std::string::npos);
    builder.add({std::uint64_t{1} << 60U, 0, 0, {}});
    builder.add({0, 0, 0, {}});
    builder.take(block);
    EXPECT_NE(mistake([&] { Replay(config, description("cycles"), {}).add(block); }).find("beyond"),
              std::string::npos);
}

// Also in a block that takes long, and of what waits for it.
TEST(IndependentReplay, EndsWithinABlock) {
    const Config config = machine(hierarchies.front());
    traces::BlockBuilder builder;
    for (std::uint64_t i = 0; i < 100000; ++i)
        builder.add({i, i * 64 % 1048576, 0, {}});
    traces::Block block;
    builder.take(block);
    Replay plain(config, description("cycles"), {});
    TimedReplay timed(config, nullptr, description("cycles"), {});
    traces::interrupt_signal = 1;
    EXPECT_THROW(plain.add(block), traces::Interrupted);
    EXPECT_THROW(timed.add(block), traces::Interrupted);
    traces::interrupt_signal = 0;
    timed.add(block);
    traces::interrupt_signal = 1;
    EXPECT_THROW(timed.finish(description("cycles")), traces::Interrupted);
    traces::interrupt_signal = 0;
}

} // namespace
} // namespace sim
