// Machines at their limits: caches of one entry, one bank, latencies of nothing, more than a thousand cores,
// memory a thousand times too slow, lines of 16 to 256 bytes. Each run ends, keeps every law (Machine::run
// checks them), computes what it should, and nothing is busy for longer than there was time; more load never
// makes memory faster.
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

#include <array>
#include <cctype>
#include <cmath>
#include <functional>

namespace sim::test {
namespace {

struct Extreme {
    const char* name;
    std::function<void(Config&)> change;
};

void set_lines(Config& c, integer bytes) {
    for (CacheConfig* cache : std::array<CacheConfig*, 2>{&c.l1, &c.l2}) {
        cache->size_bytes = cache->size_bytes / cache->line_bytes * bytes;
        cache->line_bytes = bytes;
    }
}

const std::vector<Extreme>& extremes() {
    static const std::vector<Extreme> all{
        {"as it is", [](Config&) {}},
        {"one-entry caches",
         [](Config& c) {
             for (CacheConfig* cache : std::array<CacheConfig*, 2>{&c.l1, &c.l2}) {
                 cache->ways = 1;
                 cache->replacement = "lru";
                 cache->size_bytes = cache->line_bytes;
             }
             c.l1.mshrs = c.l2.mshrs = 1;
             c.l2.banks = 1;
         }},
        {"one bank",
         [](Config& c) {
             c.l2.banks = 1;
             c.memory.channels = c.memory.ranks = c.memory.bank_groups = c.memory.banks = 1;
         }},
        {"latencies of 0",
         [](Config& c) {
             for (integer& l : c.latency)
                 l = 0;
             c.network.hop_cycles = 0;
         }},
        {"latencies of 1",
         [](Config& c) {
             for (integer& l : c.latency)
                 l = 1;
             c.l1.latency = 1;
             c.l2.latency = 2;
             c.network.hop_cycles = 1;
         }},
        {"1024 cores",
         [](Config& c) {
             c.chip.tiles = 64;
             c.chip.cores = 16;
         }},
        {"bandwidth a thousandth", [](Config& c) { c.memory.clock_ps *= 1000; }},
        {"lines of 16",
         [](Config& c) {
             set_lines(c, 16);
             c.memory.bus_bytes = 2;
         }},
        {"lines of 256", [](Config& c) { set_lines(c, 256); }},
    };
    return all;
}

class ExtremeMachines : public ::testing::TestWithParam<std::size_t> {
protected:
    const Extreme& extreme() const { return extremes()[GetParam()]; }
};

TEST_P(ExtremeMachines, FinishAndKeepTheLaws) {
    Config c = simple();
    extreme().change(c);
    SCOPED_TRACE(print_machine(c));
    ASSERT_NO_THROW(check_consistency(c, extreme().name));
    isa::address_space space{std::uint64_t{1} << 29};
    auto* counter = reinterpret_cast<word*>(space.add("data", -1, std::uint64_t{1} << 20, true));
    auto* data = reinterpret_cast<std::int32_t*>(space.add("more", -1, std::uint64_t{1} << 28, true));
    const int workers = static_cast<int>(std::min<integer>(c.all_threads(), 1024));
    Machine machine(c);
    Report r;
    ASSERT_NO_THROW(
        r = machine.run(space, workers, {{"work"}}, [&](int w) { mixed_work(data, counter, w, 2); }));
    EXPECT_EQ(counter->word, workers * 2);
    EXPECT_GT(r.cycles, 0U);
    EXPECT_LE(r.memory.busy_clocks, u(c.memory.channels) * r.memory.last_clock);
}

INSTANTIATE_TEST_SUITE_P(All, ExtremeMachines, ::testing::Range(std::size_t{0}, extremes().size()),
                         [](const auto& info) {
                             std::string name = extremes()[info.param].name;
                             for (char& letter : name)
                                 letter =
                                     std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
                             return name;
                         });

/// Memory clocks of a read burst, where so many cores each read lines of their own far apart, one after the
/// other.
double read_latency(const Config& c, int workers) {
    const Report r = run_on(
        c,
        [](std::byte* base, int w) {
            stamp s;
            for (int i = 0; i < 200; ++i) {
                const auto line = static_cast<std::size_t>(i * 7919 + w * 104729) % (std::size_t{1} << 17);
                s = load(here, base + 64 * line, 4, s);
            }
        },
        workers);
    EXPECT_GT(r.memory.read_bursts, 150U * u(workers));
    return static_cast<double>(r.memory.read_clocks + r.memory.read_wait_clocks) /
           static_cast<double>(r.memory.read_bursts);
}

TEST(ExtremeMachines, MoreLoadIsNeverFaster) {
    for (const integer slower : {1, 1000})
        for (const integer channels : {1, 4}) {
            Config c = simple();
            c.chip.tiles = 4;
            c.chip.cores = 16;
            c.memory.channels = channels;
            c.memory.clock_ps *= slower;
            double before = 0;
            for (const int workers : {1, 4, 16, 64}) {
                const double latency = read_latency(c, workers);
                EXPECT_TRUE(std::isfinite(latency));
                EXPECT_GE(latency, 0.99 * before) << slower << ' ' << channels << ' ' << workers;
                before = latency;
            }
            if (slower > 1) {
                EXPECT_GT(before, 2 * read_latency(c, 1)) << "there was no load";
            }
        }
}

} // namespace
} // namespace sim::test
