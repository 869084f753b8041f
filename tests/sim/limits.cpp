// What the report says limits a run: one program for each answer.
#include "sim/machine/limits.h"

#include "tests/sim/machines.h"

namespace sim::test {
namespace {

double share(const Report& r, const std::string& resource) {
    for (const Limit& l : limits(r))
        if (l.resource == resource)
            return static_cast<double>(l.cycles) / static_cast<double>(r.drained);
    ADD_FAILURE() << "no limit is called " << resource;
    return 0;
}

TEST(Limits, IndependentArithmeticIsBoundByIssueSlots) {
    for (integer issue_width : {1, 2}) {
        Config c = simple();
        c.core.issue_width = issue_width;
        c.core.window = 8;
        Report r = run(c, [](int) {
            for (int i = 0; i < 5000; ++i)
                scalar_op(operation::integer, stamp{});
        });
        EXPECT_STREQ(binding(limits(r)).resource, "issue slots");
        EXPECT_GT(share(r, "issue slots"), 0.99);
        EXPECT_LE(share(r, "issue slots"), 1);
        EXPECT_EQ(limiter(r).find("issue slots"), 0U);
    }
}

TEST(Limits, WideLoadsThatHitAreBoundByTheL1sPorts) {
    Config c = simple();
    c.l1.port_bytes = 4;
    c.l1.ports = 2;
    Report r = run_on(c, [](std::byte* base, int) {
        for (int i = 0; i < 500; ++i)
            load_vector(here, base, all_lanes, stamp{}, stamp{});
    });
    EXPECT_STREQ(binding(limits(r)).resource, "L1 ports");
    EXPECT_GT(share(r, "L1 ports"), 0.95);
    EXPECT_LE(share(r, "L1 ports"), 1);
}

TEST(Limits, NarrowBanksBindWhereTheL1Misses) {
    Config c = simple();
    c.l1.mshrs = c.l2.mshrs = 64;
    c.l2.bank_bytes = 1;
    c.l2.banks = 2;
    Report r = run_on(c, [](std::byte* base, int) {
        for (int i = 0; i < 1000; ++i)
            load(here, base + i * 64, 4, stamp{});
    });
    EXPECT_STREQ(binding(limits(r)).resource, "L2 banks");
    EXPECT_GT(share(r, "L2 banks"), 0.95);
    EXPECT_LE(share(r, "L2 banks"), 1);
}

TEST(Limits, FourActivatesInAWindowBindWhereEachLineIsAnotherRow) {
    Config c = simple();
    c.chip.clock_ps = c.memory.clock_ps / 2;
    c.l1.mshrs = c.l2.mshrs = 64;
    c.memory.tFAW = 200;
    Report r = run_on(c, [&](std::byte* base, int) {
        for (int i = 0; i < 1000; ++i)
            load(here, base + i * c.memory.row_bytes, 4, stamp{});
    });
    EXPECT_STREQ(binding(limits(r)).resource, "row activates");
    EXPECT_GT(share(r, "row activates"), 0.95);
    EXPECT_LE(share(r, "row activates"), 1);
}

TEST(Limits, AStreamIsBoundByTheMemoryBus) {
    Config c = simple();
    c.chip.clock_ps = c.memory.clock_ps / 2;
    c.l1.mshrs = c.l2.mshrs = 64;
    Report r = run_on(c, [](std::byte* base, int) {
        for (int i = 0; i < 4096; ++i)
            load(here, base + i * 64, 4, stamp{});
    });
    EXPECT_STREQ(binding(limits(r)).resource, "memory bus");
    EXPECT_GT(share(r, "memory bus"), 0.9);
    EXPECT_LE(share(r, "memory bus"), 1);
}

TEST(Limits, APointerChaseWaits) {
    Report r = run_on(simple(), [](std::byte* base, int) {
        stamp s;
        for (int i = 0; i < 500; ++i)
            s = load(here, base + i * 4096, 4, s);
    });
    EXPECT_LT(share(r, "issue slots"), 0.1);
    EXPECT_EQ(limiter(r).find("waiting (memory"), 0U) << limiter(r);
}

TEST(Limits, TheBusiestCoreCounts) {
    Config c = simple();
    c.chip.cores = 4;
    Report r = run(
        c,
        [](int w) {
            for (int i = 0; i < (w == 0 ? 4000 : 10); ++i)
                scalar_op(operation::integer, stamp{});
        },
        4);
    EXPECT_GT(share(r, "issue slots"), 0.99);
    EXPECT_GT(share(r, "issue slots") * 0.3,
              static_cast<double>(r.core.instructions) / (4.0 * static_cast<double>(r.cycles)));
}

} // namespace
} // namespace sim::test
