// Random valid machines keep every law (Machine::run checks them), and change nothing that a program
// computes.
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"
#include "tests/sim/random_machine.h"

#include <cstdlib>
#include <random>

namespace sim::test {
namespace {

/// RAZOR_RANDOM_MACHINES: how many (30).
int machines_wanted() {
    const char* text = std::getenv("RAZOR_RANDOM_MACHINES");
    return text != nullptr ? std::atoi(text) : 30;
}

TEST(Properties, RandomMachinesKeepTheLaws) {
    std::mt19937 random(2026);
    const int wanted = machines_wanted();
    ASSERT_GT(wanted, 0);
    for (int trial = 0; trial < wanted; ++trial) {
        Config c = random_machine(random);
        SCOPED_TRACE(print_machine(c));
        ASSERT_NO_THROW(check_consistency(c, "random"));
        Memory memory;
        int workers = 1 + static_cast<int>(random() % u(c.all_threads()));
        auto* counter = reinterpret_cast<word*>(memory.data);
        word* begin = counter + 64; // that half of the workers wait for
        auto* data = reinterpret_cast<std::int32_t*>(memory.more);
        Machine machine(c);
        Report r;
        ASSERT_NO_THROW(r = machine.run(memory.space, workers, {{"work"}}, [&](int w) {
            if (w == 0)
                release_after(begin, 3000);
            else if (w % 2 == 0)
                await(begin);
            mixed_work(data, counter, w, 12);
        }));
        EXPECT_EQ(counter->word, workers * 12);
        EXPECT_GT(r.cycles, 0U);
        EXPECT_FALSE(print_text(r).empty());
    }
}

TEST(Properties, SomeRandomMachinesSnoopAboveASharedCache) {
    std::mt19937 random(2027);
    int fast = 0, reference = 0, several_buses = 0;
    for (int trial = 0; trial < 6000; ++trial) {
        const Config c = random_machine(random);
        if (!c.coherence.snoops() || !c.beyond_tiles(c.cache_levels() - 1))
            continue;
        EXPECT_NO_THROW(check_consistency(c, "random"));
        ++(c.sim.mode == "fast" ? fast : reference);
        several_buses += c.network.buses > 1 ? 1 : 0;
    }
    EXPECT_GT(fast, 10);
    EXPECT_GT(reference, 5);
    EXPECT_GT(several_buses, 5);
}

TEST(Properties, BrokenNumbersAreNoticed) {
    Report good = run(simple(), [](int) { scalar_op(operation::add, stamp{}); });
    EXPECT_NO_THROW(check_laws(good));
    Report r = good;
    ++r.l2[0].reads;
    EXPECT_THROW(check_laws(r), std::logic_error);
    r = good;
    ++r.misplaced_lines;
    EXPECT_THROW(check_laws(r), std::logic_error);
    r = good;
    ++r.threads[0].stacks[0][0];
    EXPECT_THROW(check_laws(r), std::logic_error);
    r = good;
    ++r.core.vops;
    EXPECT_THROW(check_laws(r), std::logic_error);
    r = good;
    ++r.core.causality_waits;
    EXPECT_THROW(check_laws(r), std::logic_error);
    r = good;
    ++r.core.buffered_stores;
    EXPECT_THROW(check_laws(r), std::logic_error);
    Config c = simple();
    c.core.pairing = "any | scalar";
    c.core.shared_classes = "add";
    good = run(c, [](int) { scalar_op(operation::add, stamp{}); });
    EXPECT_NO_THROW(check_laws(good));
    r = good;
    ++r.port_instructions[0][0];
    EXPECT_THROW(check_laws(r), std::logic_error);
    r = good;
    r.shared_unit_cycles[0] = r.drained + 1;
    EXPECT_THROW(check_laws(r), std::logic_error);
}

} // namespace
} // namespace sim::test
