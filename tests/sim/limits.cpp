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
    Report r = run(simple(), [](int) {
        for (int i = 0; i < 5000; ++i)
            scalar_op(operation::integer, stamp{});
    });
    EXPECT_STREQ(binding(limits(r)).resource, "issue slots");
    EXPECT_GT(share(r, "issue slots"), 0.99);
    EXPECT_EQ(limiter(r).find("issue slots"), 0U);
}

TEST(Limits, AStreamIsBoundByTheMemoryBus) {
    Config c = simple();
    c.chip.clock_ps = c.memory.clock_ps;
    c.l1.mshrs = c.l2.mshrs = 64;
    Report r = run_on(c, [](std::byte* base, int) {
        for (int i = 0; i < 4096; ++i)
            load(here, base + i * 64, 4, stamp{});
    });
    EXPECT_STREQ(binding(limits(r)).resource, "memory bus");
    EXPECT_GT(share(r, "memory bus"), 0.9);
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
