// A trace of what cores asked for, replayed on the machine that it is of, gives all that the run's caches,
// network, directory and memory counted, to the last one.
#include "tests/sim/replay/compared.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace sim {
namespace {

using test::differences;
using test::replay;

std::string machine(const std::string& name) {
    return std::string(RAZOR_SOURCE_DIR "/configs/machines/") + name + ".toml";
}

struct Case {
    const char* name;
    std::string file;
    std::vector<std::string> settings;
};

class ExactReplay : public ::testing::TestWithParam<Case> {};

const std::vector<std::string> two_by_two = {"chip.tiles=2", "chip.cores=2", "chip.threads=2"};

std::vector<std::string> with(std::vector<std::string> base, const std::vector<std::string>& more) {
    base.insert(base.end(), more.begin(), more.end());
    return base;
}

/// How much happened in a run.
void expect_much(const Report& r) {
    EXPECT_GT(r.l1_total().misses, 1000U);
    EXPECT_GT(r.l1_total().hits, 1000U);
    EXPECT_GT(r.memory.reads, 500U);
    EXPECT_GT(r.core.modifications, 50U);
}

void expect_all_counted(const test::Recorded& run, const Config& config) {
    const ReplayResult result = replay(run.trace, config);
    EXPECT_TRUE(result.windows);
    EXPECT_TRUE(result.ended);
    EXPECT_EQ(result.waits, 0U);
    const std::vector<Comparison> all = compare_with_run(result, print_json(run.report), "run");
    EXPECT_EQ(differences(all), "");
    expect_much(run.report);
    EXPECT_GT(all.size(), 100U);
}

TEST_P(ExactReplay, CountsWhatTheRunCounted) {
    const Case& c = GetParam();
    const Config config = read_machine(machine(c.file), c.settings);
    const test::Recorded run = test::record(config, config.all_threads() > 64 ? 150 : 1500);
    expect_all_counted(run, config);
}

/// What a level passes on drives those below.
TEST_P(ExactReplay, OfWhatALevelPassesOnCountsWhatTheRunCountedBelow) {
    const Case& c = GetParam();
    const Config config = read_machine(machine(c.file), c.settings);
    for (unsigned level = 1; level <= config.tile_levels(); ++level) {
        SCOPED_TRACE(level);
        TraceSettings settings;
        settings.level = fmt::format("l{}", level);
        const test::Recorded run = test::record(config, config.all_threads() > 64 ? 150 : 1500, settings);
        const ReplayResult result = replay(run.trace, config);
        EXPECT_EQ(result.first_level, level);
        EXPECT_FALSE(result.memory_alone);
        EXPECT_TRUE(result.windows);
        EXPECT_TRUE(result.ended);
        EXPECT_EQ(result.waits, 0U);
        const std::vector<Comparison> all = compare_with_run(result, print_json(run.report), "run");
        EXPECT_EQ(differences(all), "");
        for (const Comparison& one : all)
            EXPECT_FALSE(one.part.starts_with(settings.level)) << one.part;
        expect_much(run.report);
        EXPECT_GT(all.size(), 50U);
    }
}

/// What memory is asked for drives it alone, whichever of its models: in both modes all that it counts is
/// what it counted in the run.
TEST_P(ExactReplay, OfWhatMemoryIsAskedForCountsWhatItCounted) {
    const Case& c = GetParam();
    const std::vector<std::string> reference{"sim.mode=reference", "sim.quantum=1",
                                             "memory.controller=queued"};
    for (const std::vector<std::string>& mode : {{}, {"memory.controller=queued"}, reference}) {
        SCOPED_TRACE(fmt::format("{}", fmt::join(mode, " ")));
        const Config config = read_machine(machine(c.file), with(c.settings, mode));
        TraceSettings settings;
        settings.level = "dram";
        const test::Recorded run = test::record(config, config.all_threads() > 64 ? 150 : 700, settings);
        const ReplayResult result = replay(run.trace, config);
        EXPECT_TRUE(result.memory_alone);
        EXPECT_EQ(result.first_level, config.cache_levels());
        EXPECT_TRUE(result.ended);
        EXPECT_EQ(result.waits, 0U);
        EXPECT_EQ(result.references, run.report.memory.reads + run.report.memory.writes);
        const std::vector<Comparison> all = compare_with_run(result, print_json(run.report), "run");
        EXPECT_EQ(differences(all), "");
        for (const Comparison& one : all)
            EXPECT_TRUE(one.part.starts_with("memory") || one.counter.starts_with("memory")) << one.part;
        expect_much(run.report);
        EXPECT_GT(all.size(), 20U);
    }
}

/// So does what caches that tiles share pass on, over a network on which nothing else is.
TEST(SharedLevelReplay, CountsWhatMemoryCounted) {
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{},
          {"memory.controller=queued"},
          {"l3.prefetcher=next", "sim.quantum=1000"},
          {"sim.mode=reference", "sim.quantum=1", "memory.controller=queued"},
          {"coherence.plain=directory", "l2.inclusion=inclusive"},
          {"l3.size_bytes=16384", "l3.share=4", "chip.tiles=4"}}) {
        SCOPED_TRACE(fmt::format("{}", fmt::join(more, " ")));
        const Config config = read_machine(
            machine("tiny"), with(with(two_by_two, {"l3.size_bytes=65536", "l3.share=chip"}), more));
        TraceSettings settings;
        settings.level = "l3";
        const test::Recorded run = test::record(config, 1500, settings);
        const ReplayResult result = replay(run.trace, config);
        EXPECT_TRUE(result.memory_alone);
        EXPECT_EQ(result.first_level, 3U);
        EXPECT_EQ(result.waits, 0U);
        const std::vector<Comparison> all = compare_with_run(result, print_json(run.report), "run");
        EXPECT_EQ(differences(all), "");
        expect_much(run.report);
    }
}

/// The largest error among counts of lines: where these go, whatever else happens meanwhile.
double largest_error(const std::vector<Comparison>& all, const std::set<std::string>& counters) {
    double largest = 0;
    for (const Comparison& c : all)
        if (c.part.find('[') == std::string::npos && !c.part.starts_with("traffic") &&
            counters.contains(c.counter) && c.run > 1000)
            largest = std::max(largest, c.error());
    return largest;
}

/// Over a network on which other messages were, some come sooner or later than in the run: memory is asked
/// for the same lines, but finds other rows open.
TEST(SharedLevelReplay, IsNearWhereMessagesShareTheNetwork) {
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"network.topology=mesh"},
          {"network.topology=ring", "memory.controller=queued"},
          {"network.topology=crossbar", "l3.prefetcher=next"},
          {"network.topology=bus", "coherence.plain=snoop", "l2.inclusion=inclusive"},
          {"network.topology=mesh", "sim.mode=reference", "sim.quantum=1", "memory.controller=queued"}}) {
        SCOPED_TRACE(fmt::format("{}", fmt::join(more, " ")));
        const Config config = read_machine(
            machine("tiny"), with(with(two_by_two, {"l3.size_bytes=65536", "l3.share=chip"}), more));
        TraceSettings settings;
        settings.level = "l3";
        const test::Recorded run = test::record(config, 1500, settings);
        const ReplayResult result = replay(run.trace, config);
        EXPECT_TRUE(result.memory_alone);
        EXPECT_EQ(result.waits, 0U);
        const std::vector<Comparison> all = compare_with_run(result, print_json(run.report), "run");
        EXPECT_EQ(largest_error(all, {"reads", "writes"}), 0) << differences(all);
        EXPECT_LT(largest_error(all, {"row_hits", "row_conflicts", "activates", "precharges"}), 0.01)
            << differences(all);
        EXPECT_LT(largest_error(all, {"read_clocks"}), 0.2) << differences(all);
        EXPECT_NE(differences(all), ""); // else the README says too little
        expect_much(run.report);
    }
}

class ReferenceReplay : public ::testing::TestWithParam<Case> {};
class NearReplay : public ::testing::TestWithParam<Case> {};

std::vector<std::string> reference_mode(const Case& c) {
    return with(c.settings, {"sim.mode=reference", "sim.quantum=1", "memory.controller=queued"});
}

/// Of the machine in the reference mode, in which caches within tiles act in order of time: a trace of its
/// cores tells how far they had come at each reference.
TEST_P(ReferenceReplay, CountsWhatTheRunCounted) {
    const Config config = read_machine(machine(GetParam().file), reference_mode(GetParam()));
    const test::Recorded run = test::record(config, 700);
    expect_all_counted(run, config);
}

/// Traces of caches do not tell that, nor do those of cores for another machine: what is missing moves
/// little.
TEST_P(NearReplay, IsNearToTheRun) {
    const Case& c = GetParam();
    const Config config = read_machine(machine(c.file), reference_mode(c));
    for (unsigned level = 0; level <= config.tile_levels(); ++level) {
        SCOPED_TRACE(level);
        TraceSettings settings;
        settings.level = level == 0 ? "core" : fmt::format("l{}", level);
        const test::Recorded run = test::record(config, 700, settings);
        Config other = config; // which does what this one does, and is not the trace's
        other.chip.clock_ps += level == 0 ? 1 : 0;
        const ReplayResult result = replay(run.trace, other);
        EXPECT_TRUE(result.ended);
        const std::vector<Comparison> all = compare_with_run(result, print_json(run.report), "run");
        EXPECT_LT(largest_error(all, {"reads", "hits", "misses"}), level == 0 ? 0.05 : 0.02)
            << differences(all);
        // What was changed above goes down with lines that an inclusive level recalls, a little sooner or
        // later.
        EXPECT_LT(largest_error(all, {"writes"}), 0.1) << differences(all);
        if (level == 0) {
            EXPECT_EQ(result.report.l1_total().reads, run.report.l1_total().reads);
            EXPECT_EQ(result.report.l1_total().writes, run.report.l1_total().writes);
        }
        expect_much(run.report);
    }
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
    return info.param.name;
}

const Case inclusive{"Inclusive", "tiny", {"l2.inclusion=inclusive", "l2.size_bytes=16384"}};
const Case exclusive{"Exclusive", "tiny", {"l2.inclusion=exclusive", "l2.size_bytes=32768"}};
const Case directory{
    "Directory", "tiny",
    with(two_by_two, {"coherence.plain=directory", "l2.inclusion=inclusive", "network.topology=mesh"})};

const Case snooping{
    "SnoopingAboveAnL3", "tiny",
    with(two_by_two, {"coherence.plain=snoop", "l2.inclusion=inclusive", "network.topology=bus",
                      "network.buses=2", "l3.size_bytes=65536", "l3.share=chip"})};

INSTANTIATE_TEST_SUITE_P(
    Machines, ReferenceReplay,
    ::testing::Values(
        Case{"Tiny", "tiny", {}}, Case{"Through", "tiny", {"l1.write_policy=through"}}, inclusive, exclusive,
        directory, snooping,
        Case{"Strides", "tiny", {"l1.prefetcher=stride", "l2.prefetcher=next", "l1.mshrs=2"}},
        Case{"StoreBuffer", "tiny", {"core.store_buffer=4", "tlb.entries=8", "core.gather=lane"}},
        Case{"Written", "tiny", {"sim.frame_end=write", "sim.jitter=7"}},
        Case{"Tiles", "tiny", with(two_by_two, {"network.topology=mesh"})},
        Case{"SharedL3", "tiny", with(two_by_two, {"l3.size_bytes=65536", "l3.share=chip"})},
        Case{"Copernicus", "copernicus", {"chip.tiles=3"}}, Case{"Niagara", "niagara-like", {}},
        Case{"Larrabee", "larrabee-like", {"chip.tiles=2"}}, Case{"Xeon", "xeon-x5355-2s", {}},
        Case{"Zen4", "zen4-2c", {}}, Case{"GoldenCove", "golden-cove-2c", {}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(Machines, NearReplay,
                         ::testing::Values(Case{"Tiny", "tiny", {}},
                                           Case{"Through", "tiny", {"l1.write_policy=through"}}, inclusive,
                                           exclusive, directory, snooping),
                         name_of);

INSTANTIATE_TEST_SUITE_P(
    Machines, ExactReplay,
    ::testing::Values(
        Case{"Tiny", "tiny", {}}, Case{"WholeWindows", "tiny", {"sim.quantum=1000"}},
        Case{"Quanta", "tiny", {"sim.quantum=50"}},
        Case{"NextLine", "tiny", {"l1.prefetcher=next", "l2.prefetcher=next", "l2.prefetch_degree=2"}},
        Case{"Stride", "tiny", {"l1.prefetcher=stride", "l1.prefetch_sites=4", "sim.quantum=1000"}},
        Case{"FewMshrs", "tiny", {"l1.mshrs=1", "l1.prefetcher=stride", "l1.write_back_buffer=1"}},
        Case{"Through", "tiny", {"l1.write_policy=through", "l1.write_miss=around", "l2.replacement=plru"}},
        Case{"Exclusive", "tiny", {"l2.inclusion=exclusive", "l2.size_bytes=32768"}},
        Case{"Inclusive", "tiny", {"l2.inclusion=inclusive", "l2.size_bytes=16384", "l1.replacement=srrip"}},
        Case{"StoreBuffer", "tiny", {"core.store_buffer=4", "tlb.entries=8", "core.gather=lane"}},
        Case{"Jitter", "tiny", {"sim.jitter=7", "l2.line_bytes=128"}},
        Case{"Queued", "tiny", {"memory.controller=queued"}},
        Case{"Written", "tiny", {"sim.frame_end=write", "sim.miss_causes=on"}},
        Case{"SharedL3", "tiny",
             with(two_by_two,
                  {"l3.size_bytes=262144", "l3.share=chip", "l3.prefetcher=next", "sim.quantum=1000"})},
        Case{"Directory", "tiny",
             with(two_by_two,
                  {"coherence.plain=directory", "l2.inclusion=inclusive", "network.topology=mesh"})},
        snooping,
        Case{"SnoopingQueued", "tiny",
             with(snooping.settings, {"memory.controller=queued", "sim.quantum=1000"})},
        Case{"SmallDirectory", "tiny",
             with(two_by_two,
                  {"coherence.plain=directory", "l2.inclusion=inclusive", "coherence.directory_entries=256",
                   "sim.quantum=1000", "memory.controller=queued"})},
        // Of several levels below the L1s, all but the last may refuse what they have made room for.
        Case{"ThreeLevels", "tiny", {"l3.size_bytes=65536", "l3.share=tile"}},
        Case{"FourLevels",
             "tiny",
             {"l2.size_bytes=8192", "l2.share=core", "l2.mshrs=2", "l3.size_bytes=32768", "l3.share=tile",
              "l3.mshrs=2", "l4.size_bytes=131072", "l4.share=tile", "l1.mshrs=4"}},
        Case{"InclusiveLevels",
             "tiny",
             {"l2.size_bytes=16384", "l2.inclusion=inclusive", "l2.write_back_buffer=1", "l2.mshrs=1",
              "l3.size_bytes=65536", "l3.inclusion=inclusive", "l3.share=tile"}},
        Case{"CoherentLevels", "tiny",
             with(two_by_two, {"coherence.plain=directory", "l2.inclusion=inclusive", "l2.mshrs=1",
                               "l3.size_bytes=65536", "l3.inclusion=inclusive", "l3.share=tile"})},
        Case{"Copernicus", "copernicus", {"chip.tiles=3"}}, Case{"Niagara", "niagara-like", {}},
        Case{"Larrabee", "larrabee-like", {"chip.tiles=4"}}, Case{"Xeon", "xeon-x5355-2s", {}},
        Case{"Zen4", "zen4-2c", {}}, Case{"GoldenCove", "golden-cove-2c", {}}),
    name_of);

} // namespace
} // namespace sim
