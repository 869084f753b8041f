// Traces for tests.
#pragma once

#include "traces/block_builder.h"
#include "traces/description.h"

#include <array>
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
    d.picture = {60, 44, 8}; // 8 x 6 tiles
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

/// Each stream works some references long for a tile of small_description(), and now and then for none.
inline std::vector<Reference> with_tiles(std::vector<Reference> all, std::size_t length = 9) {
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i].tile = static_cast<std::uint32_t>((i / length * 31 + all[i].stream % 3 * 7) % 49);
    return all;
}

/// What two caches of 32 sets pass on: a line that comes, and mostly one of the oldest of its set that makes
/// room; now and then one that never came, or one that leaves twice. `left`: how many leave.
inline std::vector<Reference> evicting(std::size_t count, std::size_t& left) {
    std::mt19937_64 random(3);
    std::array<std::vector<std::vector<std::uint64_t>>, 2> sets;
    for (auto& cache : sets)
        cache.resize(32);
    std::vector<Reference> all;
    for (std::uint64_t time = 0; all.size() < count; time += 2) {
        const auto stream = static_cast<std::uint32_t>(random() % 2);
        const std::uint64_t line = random() % (std::uint64_t{1} << 30U);
        std::vector<std::uint64_t>& set = sets[stream][line % 32];
        Reference r{time, 0, stream, {}};
        r.what.size = 64;
        if (set.size() == 8) {
            const std::size_t at = random() % 3;
            r.what.kind = random() % 4 == 0 ? Kind::clean_back : Kind::write_back;
            r.address = (random() % 50 == 0 ? random() >> 6U : set[at]) * 64;
            set.erase(set.begin() + static_cast<std::ptrdiff_t>(at));
            all.push_back(r);
            if (random() % 50 == 0)
                all.push_back(r);
            ++left;
        }
        r.what.kind = random() % 3 == 0 ? Kind::write : Kind::read;
        r.address = line * 64;
        set.push_back(line);
        all.push_back(r);
    }
    return all;
}

/// So that lines that leave caches are lines like any other.
inline void hide_evictions(Block& block) {
    for (Class& c : block.table)
        c.kind = c.kind == Kind::write_back   ? Kind::write_through
                 : c.kind == Kind::clean_back ? Kind::word
                                              : c.kind;
}

inline bool equal(const Reference& a, const Reference& b) {
    return a.time == b.time && a.address == b.address && a.stream == b.stream && a.what == b.what &&
           a.tile == b.tile;
}

/// Of a block, in its own order.
inline std::vector<Reference> references_of(const Block& block) {
    std::vector<Reference> out;
    for (const Segment& s : block.segments)
        for (std::size_t i = s.begin; i < s.end; ++i)
            out.push_back({block.times[i], block.addresses[i], s.stream, block.what(i), block.tile(i)});
    return out;
}

} // namespace traces::test
