#include "sim/validation/tlb_forms.h"

#include "sim/machine/machine.h"

#include <fmt/format.h>

namespace sim {
namespace {

using namespace isa::timing;

constexpr site here{"TLB form", 1};

Report chase(const Config& c, int pages, int turns) {
    isa::address_space space{std::uint64_t{1} << 30};
    std::byte* base = space.add("data", -1, std::uint64_t{1} << 29, true);
    return Machine(c).run(space, 1, {{"work"}}, [&](int) { chase_pages(base, c, pages, turns); });
}

/// A turn in which nothing is new takes so many cycles a load.
CoreForm form(const std::string& name, const Config& c, int pages, integer cycles_a_load) {
    return {name, static_cast<cycle>(pages * cycles_a_load), static_cast<std::uint64_t>(pages), [=] {
                const Report before = chase(c, pages, 3);
                Report r = chase(c, pages, 4);
                r.cycles -= before.cycles;
                r.core.instructions -= before.core.instructions;
                return r;
            }};
}

} // namespace

Config plain_tlb(integer entries) {
    Config c = plain_core();
    c.l1.size_bytes = 64 * 1024;
    c.tlb.entries = entries;
    c.tlb.walk = "fixed";
    return c;
}

void chase_pages(std::byte* base, const Config& config, int pages, int turns) {
    stamp s;
    for (int t = 0; t < turns; ++t)
        for (int i = 0; i < pages; ++i)
            s = load(here, base + i * (config.tlb.page_bytes + config.l1.line_bytes), 4, s);
}

std::vector<CoreForm> tlb_forms() {
    const Config fixed = plain_tlb(16);
    Config second = fixed;
    second.tlb.second_entries = 64;
    second.tlb.second_ways = 4;
    Config tables = fixed;
    tables.tlb.walk = "tables";
    Config roots = tables;
    roots.tlb.walk_cache = 0;
    Config large = roots;
    large.tlb.page_bytes = 2 * 1024 * 1024;
    const integer l1 = fixed.l1.latency, walk = fixed.tlb.walk_cycles, behind = second.tlb.second_latency;
    return {
        form("chase over as many pages as entries", fixed, 16, l1),
        form("chase over one page more", fixed, 17, walk + l1),
        form("chase over pages of the second TLB", second, 48, behind + l1),
        form("chase over more than that", second, 81, behind + walk + l1),
        form("walks that read the last of four tables", tables, 17, l1 + l1),
        form("walks that read all four tables", roots, 17, 4 * l1 + l1),
        form("walks of pages of 2 MiB through three tables", large, 17, 3 * l1 + l1),
    };
}

} // namespace sim
