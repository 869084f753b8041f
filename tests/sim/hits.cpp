// Accesses that do nothing but hit are served together and at once; where references are noted for a trace,
// each by itself. No report may tell which it was.
#include "tests/sim/replay/workload.h"

#include <gtest/gtest.h>

#include <fmt/core.h>

#include <array>

namespace sim::test {
namespace {

/// Whole vectors, in lines and across them, more values than there are registers, gathers and scatters of
/// lanes that are neighbours, and single elements, of what fits an L1 and of what does not; by a seed.
void use_much(const WorkMemory& m, int worker, int count) {
    using namespace isa::timing;
    std::mt19937 random(static_cast<std::uint32_t>(worker) + 1);
    std::byte* const own = m.own + static_cast<std::ptrdiff_t>(worker % 64) * 65536;
    const auto site_of = [](std::uint32_t line) { return site{"hits.cpp", line}; };
    constexpr std::uint64_t all = ~std::uint64_t{0} >> (64 - ISA_WIDTH);
    std::array<std::int32_t, 64> index{};
    std::array<stamp, 12> values{};
    const auto some = [&]() -> stamp& { return values[random() % values.size()]; };
    for (int i = 0; i < count; ++i) {
        const std::uint32_t reach = i % 8 == 0 ? 60000 : 4096;
        const std::uint64_t lanes = i % 3 == 0 ? all : (std::uint64_t{random()} << 32U | random()) & all;
        std::int32_t from = static_cast<std::int32_t>(random() % (reach / 4));
        for (std::int32_t& k : index)
            k = from = random() % 4 == 0 ? static_cast<std::int32_t>(random() % (reach / 4)) : from + 1;
        switch (random() % 8) {
        case 0:
            some() = load_vector(site_of(1), own + random() % reach / 128 * 128, all, stamp{}, stamp{});
            break;
        case 1:
            some() = load_vector(site_of(2), own + random() % reach / 4 * 4, lanes, stamp{}, stamp{});
            break;
        case 2:
            store_vector(site_of(3), own + random() % reach / 64 * 64, all, stamp{}, some(), stamp{});
            break;
        case 3:
            some() = gather(site_of(4), own, index.data(), lanes, stamp{}, stamp{}, stamp{});
            break;
        case 4:
            scatter(site_of(5), own, index.data(), lanes, stamp{}, stamp{}, some(), stamp{});
            break;
        case 5:
            store(site_of(6), own + random() % reach / 4 * 4, 4, stamp{}, stamp{});
            load(site_of(7), own + random() % reach / 4 * 4, 8, stamp{});
            break;
        default:
            some() = vector_op(operation::fused, some(), some(), some());
        }
    }
}

struct Hits : testing::TestWithParam<const char*> {};

TEST_P(Hits, AreTheSameWhetherNotedOrNot) {
    for (const integer lanes : {1, 4, 16})
        for (const integer line : {32, 64, 128}) {
            Config c;
            c.chip.tiles = 1;
            c.chip.cores = 1;
            c.chip.threads = 24;
            c.core.lanes = lanes;
            c.core.window = 8;
            c.core.vector_registers = 4;
            c.core.gather = lanes == 16 ? "line" : "lane";
            c.l1.line_bytes = line;
            c.l2.line_bytes = std::max<integer>(64, line);
            c.l1.size_bytes = 16384;
            c.l1.port_bytes = lanes == 16 ? 4 : 16; // then ports are far behind
            c.l1.ports = line == 32 ? 2 : 1;
            c.l1.ways = line == 32 ? 16 : 4;
            c.sim.quantum = lanes == 4 ? 1 : 1000;
            c.sim.mode = GetParam();
            if (c.sim.mode == "reference") {
                c.memory.controller = "queued";
                c.sim.quantum = 0;
                c.sim.window = 0;
            }
            const auto run = [&](Recorder* recorder) {
                const WorkMemory memory;
                RunOptions options;
                options.recorder = recorder;
                const Machine machine(c);
                return machine.run(
                    memory.space, machine.threads(), {{"work"}},
                    [&](int worker) { use_much(memory, worker, 40); }, 1, options);
            };
            std::string trace;
            Recorder recorder({}, c, traces::memory_sink(trace));
            const Report noted = run(&recorder), plain = run(nullptr);
            recorder.finish();
            EXPECT_EQ(print_json(plain, false), print_json(noted, false))
                << fmt::format("{} lanes, lines of {}", lanes, line);
            EXPECT_GT(plain.core.spill_loads, 100U);
        }
}

INSTANTIATE_TEST_SUITE_P(Modes, Hits, testing::Values("fast", "reference"),
                         [](const auto& p) { return std::string(p.param); });

} // namespace
} // namespace sim::test
