// What rays cost beside others: steps of traversal and tests of rays against things, and the operations of
// the kernels where the target tells them.
#pragma once

#include "razor/frame/frame.h"
#include "tests/kernels/targets.h"
#ifdef RAZOR_HAS_SIMULATED
#include "tests/kernels/recording_port.h"
#endif

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace razor::test {

struct Effort {
    std::int64_t rays = 0, steps = 0, operations = 0; // operations: 0 of native targets

    double steps_a_ray() const { return static_cast<double>(steps) / static_cast<double>(rays); }
    double operations_a_ray() const { return static_cast<double>(operations) / static_cast<double>(rays); }
};

inline std::int64_t steps(const Counters& c) {
    return c.node_visits + c.box_tests + c.block_tests + c.cell_tests + c.quad_tests;
}

#ifdef RAZOR_HAS_SIMULATED
/// Counts operations while it lives.
class OperationCount : public Listener {
public:
    explicit OperationCount(const KernelTable& target) {
        if (&target == &simulated::kernels)
            listen(this);
    }
    OperationCount(const OperationCount&) = delete;
    OperationCount& operator=(const OperationCount&) = delete;
    ~OperationCount() override { listen(nullptr); }
    void event(Event, isa::timing::site, std::uint32_t, std::span<const std::uint32_t>,
               std::uint32_t) override {
        ++count;
    }
    std::int64_t count = 0;
};
#else
struct OperationCount {
    explicit OperationCount(const KernelTable&) {}
    std::int64_t count = 0;
};
#endif

/// Of so many rays, which `trace` sends through the frame.
template <class Trace>
Effort effort_of(const Frame& frame, const KernelTable& target, std::size_t rays, Trace trace) {
    const std::int64_t before = steps(frame.statistics().counters);
    const OperationCount operations(target);
    trace();
    return {static_cast<std::int64_t>(rays), steps(frame.statistics().counters) - before, operations.count};
}

/// At most so many times what is usual.
inline void expect_at_most(double times, const Effort& usual, const Effort& seen, const std::string& what) {
    EXPECT_GT(usual.steps_a_ray(), 0) << what;
    EXPECT_LE(seen.steps_a_ray(), times * usual.steps_a_ray()) << what << ": steps";
    EXPECT_LE(seen.operations_a_ray(), times * usual.operations_a_ray()) << what << ": operations";
}

} // namespace razor::test
