// Sampled runs: what they count is what a detailed run counts, all in detail is the detailed run, and their
// estimates are right as often as they say.
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

#include <array>
#include <cmath>
#include <random>

namespace sim::test {
namespace {

using Body = std::function<void(std::byte*, std::byte*, int)>;

struct Sampled {
    Report report;
    Estimate estimate;
};
Sampled run_sampled(const Config& c, const Sampling& sampling, const Body& body, int workers = 1) {
    Memory memory;
    RunOptions options;
    Sampled out;
    options.sampling = &sampling;
    options.estimate = &out.estimate;
    out.report = Machine(c).run(
        memory.space, workers, {{"work"}}, [&](int w) { body(memory.data, memory.more, w); }, 1, options);
    return out;
}
Report run_in_detail(const Config& c, const Body& body, int workers = 1) {
    Memory memory;
    return Machine(c).run(memory.space, workers, {{"work"}},
                          [&](int w) { body(memory.data, memory.more, w); });
}

/// Vectors, gathers, branches and a counter of the worker's own, on more memory than the caches hold;
/// `pieces` of that, taken by whoever comes first.
void mix(std::byte* data, std::byte* more, int worker, int pieces) {
    auto* taken = reinterpret_cast<word*>(more);
    auto* counter = reinterpret_cast<word*>(more) + (worker + 1) * 1024;
    for (std::int32_t i = take_ticket(taken, 1); i < pieces; i = take_ticket(taken, 1))
        mixed_work(reinterpret_cast<std::int32_t*>(data) + i % 16 * 8192 + worker * 1024, counter, worker,
                   40);
}

/// Operations whose vectors were all made some time ago, more of them than registers hold; by a seed.
void use_old_values(std::byte* data, int count) {
    using namespace isa::timing;
    std::mt19937 random(5);
    constexpr std::uint64_t all = ~std::uint64_t{0} >> (64 - ISA_WIDTH);
    std::array<std::int32_t, 64> index{};
    std::array<stamp, 12> values{};
    const auto some = [&]() -> stamp& { return values[random() % values.size()]; };
    const auto place = [&](std::uint32_t step) { return data + random() % 400000 / step * step; };
    const auto site_of = [](std::uint32_t line) { return site{"sampling.cpp", line}; };
    for (int i = 0; i < count; ++i) {
        const std::uint64_t lanes =
            random() % 2 == 0 ? all : (std::uint64_t{random()} << 32U | random()) & all;
        for (std::int32_t& k : index)
            k = static_cast<std::int32_t>(random() % 1000);
        switch (random() % 9) {
        case 0:
            some() = load_vector(site_of(1), place(4), lanes, stamp{}, some());
            break;
        case 1:
            some() = load_broadcast(site_of(2), place(4), 4, stamp{});
            break;
        case 2:
            store_vector(site_of(3), place(64), lanes, stamp{}, some(), some());
            break;
        case 3:
            some() = gather(site_of(4), place(64), index.data(), lanes, stamp{}, some(), some());
            break;
        case 4:
            scatter(site_of(5), place(64), index.data(), lanes, stamp{}, some(), some(), some());
            break;
        case 5:
            branch(site_of(6), cross_to_scalar(operation::reduce, some(), stamp{}), random() % 2 == 0);
            break;
        case 6:
            some() = cross_op(operation::shuffle, some(), some());
            break;
        default:
            some() = vector_op(operation::fused, some(), some(), some());
        }
    }
}

Config shipped(const std::string& name) {
    return read_machine(std::string(RAZOR_SOURCE_DIR "/configs/machines/") + name);
}

// Everything that one thread does and touches is counted as in detail, in each mode and whatever the caches
// do; but below the L1s of the reference mode, where lines come in order of time, some few fill another
// place.
TEST(Sampling, WarmingCountsWhatADetailedRunCounts) {
    struct Case {
        const char* what;
        std::vector<std::string> settings;
    };
    const Case cases[] = {
        {"plain", {}},
        {"reference", {"sim.mode=reference", "memory.controller=queued"}},
        {"spilling", {"core.vector_registers=2"}},
        {"through", {"l1.write_policy=through", "l1.write_miss=around"}},
        {"inclusive", {"l2.inclusion=inclusive"}},
        {"exclusive", {"l2.inclusion=exclusive"}},
        {"broadcasts", {"core.broadcasts=register", "core.vector_registers=3"}},
        {"interleaved", {"core.broadcasts=register", "core.vector_registers=1", "core.interleaved_values=3"}},
        {"untouched by idle lanes", {"core.skip_idle=on", "core.gather=lane"}},
        {"lanes", {"core.gather=lane", "lanes.scatter=on", "lanes.masked=on"}},
        {"moves", {"core.scalar_moves=0.25", "core.vector_moves=0.5"}},
        {"folding", {"core.address_folding=on", "core.memory_operands=1"}}};
    const Body kernels = [](std::byte* data, std::byte* more, int w) { mix(data, more, w, 30); };
    const Body old_values = [](std::byte* data, std::byte*, int) { use_old_values(data, 20000); };
    for (const Case& k : cases)
        for (const Body& body : {kernels, old_values}) {
            SCOPED_TRACE(k.what);
            const Config c =
                describe_machine(RAZOR_SOURCE_DIR "/configs/machines/tiny.toml", k.settings).config;
            const Report all = run_in_detail(c, body);
            // One unit at the beginning, and the rest is warmed.
            const Sampled s = run_sampled(c, {.fraction = 1e-6, .unit = 200, .before = 200}, body);
            ASSERT_EQ(s.estimate.units, 1U);
            ASSERT_LT(s.estimate.detailed, 0.1 * static_cast<double>(all.cycles));
            for (const auto& row : core_counters)
                EXPECT_EQ(s.report.core.*row.count, all.core.*row.count) << row.name;
            EXPECT_EQ(s.report.by_kind, all.by_kind);
            const auto expect = [&](unsigned level, std::uint64_t warmed, std::uint64_t detailed) {
                const bool in_time = level > 0 && c.sim.mode == "reference";
                EXPECT_NEAR(static_cast<double>(warmed), static_cast<double>(detailed),
                            in_time ? 2e-4 * static_cast<double>(detailed) : 0);
            };
            for (unsigned level = 0; level < 2; ++level) {
                SCOPED_TRACE(level);
                const CacheCounters a = s.report.cache_total(level), b = all.cache_total(level);
                EXPECT_EQ(a.reads, b.reads);
                EXPECT_EQ(a.writes, b.writes);
                expect(level, a.hits, b.hits);
                expect(level, a.misses, b.misses);
                expect(level, a.write_backs, b.write_backs);
            }
            expect(2, s.report.memory.reads, all.memory.reads);
            expect(2, s.report.memory.writes, all.memory.writes);
        }
}

TEST(Sampling, AllInDetailIsTheDetailedRun) {
    const Body body = [](std::byte* data, std::byte* more, int w) { mix(data, more, w, 40); };
    for (const char* mode : {"fast", "reference"}) {
        const Config c = describe_machine(RAZOR_SOURCE_DIR "/configs/machines/tiny.toml",
                                          {std::string("sim.mode=") + mode})
                             .config;
        const Report all = run_in_detail(c, body, 8);
        const Sampled s = run_sampled(c, {.fraction = 1}, body, 8);
        EXPECT_EQ(print_json(s.report, false), print_json(all, false)) << mode;
        EXPECT_EQ(s.estimate.cycles.low, static_cast<double>(all.cycles));
        EXPECT_EQ(s.estimate.cycles.high, static_cast<double>(all.cycles));
    }
}

// Many short units end and begin in the middle of operations: of spilled values that come back, of pages that
// are looked up. What a thread was at then is not lost, nor is the thread.
TEST(Sampling, ModesMayChangeWithinAnOperation) {
    const Body body = [](std::byte* data, std::byte*, int) { use_old_values(data, 6000); };
    for (const char* mode : {"fast", "reference"}) {
        SCOPED_TRACE(mode);
        const Config c = describe_machine(RAZOR_SOURCE_DIR "/configs/machines/tiny.toml",
                                          {std::string("sim.mode=") + mode, "core.vector_registers=4"})
                             .config;
        const auto truth = static_cast<double>(run_in_detail(c, body, 8).cycles);
        const Sampled s = run_sampled(c, {.fraction = 0.8, .unit = 300, .before = 300}, body, 8);
        EXPECT_GT(s.estimate.units, 100U);
        EXPECT_LT(static_cast<double>(s.report.cycles),
                  2 * truth); // a thread that waits for ever ends at 2^48
    }
}

// Threads that share caches and memory, in both modes: a third of the time says what all of it says, few
// though units are here.
TEST(Sampling, EstimatesCyclesOfManyThreads) {
    const Body body = [](std::byte* data, std::byte* more, int w) { mix(data, more, w, 160); };
    for (const char* mode : {"fast", "reference"}) {
        const Config c = describe_machine(RAZOR_SOURCE_DIR "/configs/machines/tiny.toml",
                                          {std::string("sim.mode=") + mode})
                             .config;
        const auto truth = static_cast<double>(run_in_detail(c, body, 8).cycles);
        int held = 0;
        for (std::uint32_t seed = 1; seed <= 6; ++seed) {
            const Estimate e =
                run_sampled(c, {.fraction = 0.3, .seed = seed, .unit = 3000, .before = 6000}, body, 8)
                    .estimate;
            EXPECT_LT(e.detailed, 0.5 * truth);
            EXPECT_GT(e.units, 5U);
            EXPECT_NEAR(e.cycles.value, truth, 0.13 * truth) << mode << ", seed " << seed;
            held += e.cycles.low <= truth && truth <= e.cycles.high ? 1 : 0;
        }
        EXPECT_GE(held, 3) << mode;
    }
}

TEST(Sampling, IsAFunctionOfItsSeed) {
    const Body body = [](std::byte* data, std::byte* more, int w) { mix(data, more, w, 40); };
    const Config c = shipped("tiny.toml");
    const auto cycles = [&](std::uint32_t seed) {
        return run_sampled(c, {.fraction = 0.2, .seed = seed, .unit = 2000, .before = 1000}, body, 8)
            .estimate.cycles.value;
    };
    EXPECT_EQ(cycles(1), cycles(1));
    EXPECT_NE(cycles(1), cycles(2));
}

/// A run without a machine: in each 100 cycles four threads do work that takes `costs`, times what drifts and
/// what is drawn; gaps take what the sampler expects.
struct Made {
    double truth = 0;
    Estimate estimate;
};
WorkByCore on_one_core(const SampledWork& w) {
    return {{w}, w.of[SampledWork::lines]};
}
Made make_run(const Sampling& sampling, double drift, double noise, std::uint32_t seed) {
    const SampledCosts costs = {2, 1.5, 20, 200, 30};
    Sampler sampler(sampling, {1, 1, 10, 100, 10});
    std::mt19937 random(seed);
    std::normal_distribution<double> drawn(0, noise);
    std::uniform_real_distribution<double> share(0, 1);
    SampledWork done;
    Made out;
    double clock = 0;
    const int steps = 40000;
    for (int i = 0; i < steps; ++i) {
        const double build = i < steps / 4 ? 1 : 0.1;
        SampledWork w;
        w.of = {build * 100 * share(random), 100 * share(random), 4 * share(random), build * share(random),
                share(random)};
        double takes = 0, expected = 0;
        for (std::size_t k = 0; k < costs.size(); ++k) {
            takes += w.of[k] * costs[k];
            expected += w.of[k] * sampler.costs()[k];
            done.of[k] += w.of[k];
        }
        takes *= 1 + drift * std::sin(i * 1e-3) + drawn(random);
        out.truth += takes / 4;
        done.spent += sampler.warms() ? 0 : takes;
        clock += (sampler.warms() ? expected * sampler.pace(0) : takes) / 4;
        if (static_cast<cycle>(clock) >= sampler.next())
            sampler.come_to(static_cast<cycle>(clock), on_one_core(done));
    }
    out.estimate = sampler.estimate(static_cast<cycle>(clock), on_one_core(done));
    return out;
}

// Of two cores that do the same work one takes three times as long: 3 and 1 where both together say 2, the
// last eight units beside two that say nothing.
TEST(Sampling, EachCoreHasAPaceOfItsOwn) {
    Sampler sampler({.fraction = 0.1, .unit = 2000, .before = 500}, {1, 1, 10, 100, 10});
    EXPECT_EQ(sampler.pace(0), 1);
    WorkByCore done;
    done.cores.resize(2);
    for (int i = 0; i < 300; ++i) {
        for (std::size_t c = 0; c < 2; ++c) {
            done.cores[c].of[SampledWork::others] += 1000;
            done.cores[c].spent += sampler.warms() ? 0 : c == 0 ? 3000 : 1000;
        }
        sampler.come_to(sampler.next(), done);
    }
    EXPECT_NEAR(sampler.costs()[SampledWork::others], 2, 0.01);
    EXPECT_NEAR(sampler.pace(0), 1.4, 0.01);
    EXPECT_NEAR(sampler.pace(1), 0.6, 0.01);
}

TEST(Sampling, FindsCostsOfWorkThatFollowsThem) {
    const Made run = make_run({.fraction = 0.1, .unit = 4000, .before = 1000}, 0, 0, 1);
    EXPECT_NEAR(run.estimate.cycles.value, run.truth, 0.002 * run.truth);
    EXPECT_NEAR(run.estimate.costs[SampledWork::builds], 2, 0.3);
    EXPECT_NEAR(run.estimate.costs[SampledWork::others], 1.5, 0.3);
    EXPECT_NEAR(run.estimate.costs[SampledWork::lines], 200, 20);
    EXPECT_LT(run.estimate.spread, 0.02);
}

// Intervals hold the truth as often as they say, though costs drift and are noisy; and they are not idle:
// with more units they are narrower.
TEST(Sampling, IntervalsHoldTheTruth) {
    int held = 0;
    const int runs = 60;
    double few = 0, many = 0;
    for (std::uint32_t seed = 1; seed <= runs; ++seed) {
        const Made run =
            make_run({.fraction = 0.05, .seed = seed, .unit = 2000, .before = 500}, 0.3, 1, seed);
        held += run.estimate.cycles.low <= run.truth && run.truth <= run.estimate.cycles.high ? 1 : 0;
        few += run.estimate.cycles.error();
        many += make_run({.fraction = 0.4, .seed = seed, .unit = 2000, .before = 500}, 0.3, 1, seed)
                    .estimate.cycles.error();
    }
    EXPECT_GE(held, 54);
    EXPECT_LT(few / runs, 0.12);
    EXPECT_LT(many, 0.7 * few);
}

/// As much too many as were found on configs/machines/tiny.toml (README.md), by how far cores look ahead.
TEST(Sampling, MissesOfL1sMayBeFartherOffWhereThreadsShareACore) {
    Estimate e;
    e.confidence = 0.95;
    EXPECT_EQ(Estimate::unseen_of_l1(1, 512), Estimate::unseen);
    for (const auto& [window, found] : {std::pair{1U, 0.056}, {8U, 0.116}, {32U, 0.162}, {200U, 0.338}})
        EXPECT_GT(e.count_error(Estimate::unseen_of_l1(2, window)), found) << window;
    EXPECT_LT(e.count_error(Estimate::unseen_of_l1(2, 8)), 0.15);
}

TEST(Sampling, SaysWhichMachinesItDoesNotKnow) {
    EXPECT_EQ(Machine(shipped("tiny.toml")).not_sampled(), "");
    EXPECT_EQ(Machine(shipped("copernicus.toml")).not_sampled(), "");
    const Machine coherent(shipped("xeon-x5355-2s.toml"));
    EXPECT_NE(coherent.not_sampled(), "");
    const Sampling half{.fraction = 0.5};
    RunOptions options;
    options.sampling = &half;
    Memory memory;
    EXPECT_THROW(coherent.run(
                     memory.space, 1, {{"work"}}, [](int) {}, 1, options),
                 std::invalid_argument);
}

} // namespace
} // namespace sim::test
