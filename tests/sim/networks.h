// Networks of the tests.
#pragma once

#include "sim/validation/network_forms.h"
#include "tests/sim/machines.h"

#include <array>

namespace sim::test {

inline constexpr std::array topologies = {"crossbar", "ring", "mesh", "bus"};
inline constexpr integer kib = 1024;

/// An L3 of all tiles.
inline Config with_l3(Config c, integer banks) {
    c.l3.size_bytes = 1024 * kib;
    c.l3.share = "chip";
    c.l3.banks = banks;
    return c;
}
inline std::uint64_t flits(const Config& c, integer bytes) {
    return u((bytes + c.network.link_bytes - 1) / c.network.link_bytes);
}
/// Lines that one tile reads one after the other.
inline Report read_lines(const Config& c, int lines, integer reader, std::int64_t apart = 64,
                         std::int64_t first = 0) {
    return run_on(
        c,
        [=](std::byte* base, int w) {
            stamp s;
            for (int i = 0; w == reader && i < lines; ++i)
                s = load(here, base + (first + i) * apart, 4, s);
        },
        static_cast<int>(c.chip.tiles));
}

} // namespace sim::test
