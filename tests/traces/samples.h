// Traces for tests.
#pragma once

#include "traces/block_builder.h"
#include "traces/description.h"

#include <random>
#include <vector>

namespace traces::test {

inline Description small_description() {
    Description d;
    d.program = "test";
    d.level = "core";
    d.time = "cycles";
    d.line_bytes = 64;
    d.structures = {"unknown", "kd nodes", "packets"};
    d.phases = {"unknown", "traverse"};
    d.work = {"unknown", "camera", "light"};
    d.streams = {"thread 0", "thread 1"};
    d.window = 200;
    d.regions = {{0, 65536, 1, false}, {65536, 131072, 2, true}};
    d.configuration = "chip.tiles = 1\n# \"quoted\"\n";
    return d;
}

/// References of all kinds and extremes, in several streams.
inline std::vector<Reference> mixed_references(std::size_t count, std::uint32_t seed,
                                               std::uint64_t sites = 9) {
    std::mt19937_64 random(seed);
    std::vector<Reference> out;
    std::uint64_t time = 1000;
    for (std::size_t i = 0; i < count; ++i) {
        Reference r;
        time += random() % 5;
        r.time = time - random() % 3;
        r.address = random() % 50 == 0 ? random() : 0x10000 + random() % 4096 * 4;
        if (random() % 97 == 0)
            r.address = ~std::uint64_t{0};
        r.stream = static_cast<std::uint32_t>(random() % 7 == 0 ? ~std::uint32_t{0} : random() % 3);
        r.what.kind = static_cast<Kind>(random() % kind_names.size());
        r.what.part = static_cast<Part>(random() % 2 * 3); // pieces follow others
        r.what.size = random() % 31 == 0 ? ~std::uint32_t{0} : static_cast<std::uint32_t>(random() % 64);
        r.what.structure = static_cast<std::uint16_t>(random() % 3);
        r.what.phase = static_cast<std::uint16_t>(random() % 2);
        r.what.work = static_cast<std::uint16_t>(random() % 3);
        r.what.site = sites == 0 ? 0 : random() % (sites + 1);
        r.what.detail = random() % 3 == 0 ? static_cast<std::uint32_t>(random()) & 0x30101U : 0;
        out.push_back(r);
    }
    return out;
}

inline bool equal(const Reference& a, const Reference& b) {
    return a.time == b.time && a.address == b.address && a.stream == b.stream && a.what == b.what;
}

/// Of a block, in its own order.
inline std::vector<Reference> references_of(const Block& block) {
    std::vector<Reference> out;
    for (const Segment& s : block.segments)
        for (std::size_t i = s.begin; i < s.end; ++i)
            out.push_back({block.times[i], block.addresses[i], s.stream, block.what(i)});
    return out;
}

} // namespace traces::test
