// Sums and shares of a report.
#include "sim/machine/report.h"

namespace sim {

double Report::seconds() const {
    return static_cast<double>(cycles) * static_cast<double>(config.chip.clock_ps) * 1e-12;
}

namespace {

CacheCounters sum_of(const std::vector<CacheCounters>& all) {
    CacheCounters sum;
    for (const CacheCounters& c : all)
        for (const auto& row : cache_counters)
            sum.*row.count += c.*row.count;
    return sum;
}

void add(Stack& sum, const Stack& s) {
    for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] += s[i];
}

} // namespace

CacheCounters Report::cache_total(unsigned level) const {
    return sum_of(caches(level));
}

TlbCounters Report::tlb_total() const {
    TlbCounters sum;
    for (const TlbCounters& c : tlb)
        for (const auto& row : tlb_counters)
            sum.*row.count += c.*row.count;
    return sum;
}

Stack ThreadReport::stack() const {
    Stack sum{};
    for (const Stack& s : stacks)
        add(sum, s);
    return sum;
}

std::vector<Stack> Report::core_stacks() const {
    std::vector<Stack> cores(l1.size(), Stack{});
    for (const ThreadReport& t : threads)
        add(cores[static_cast<std::size_t>(t.core)], t.stack());
    return cores;
}

Stack Report::stack() const {
    Stack sum{};
    for (const ThreadReport& t : threads)
        add(sum, t.stack());
    return sum;
}

} // namespace sim
