// Programs for the machine that do all that programs may do to memory, and their traces.
#pragma once

#include "isa/address_space.h"
#include "isa/simulated/port.h"
#include "sim/config/machine_file.h"
#include "sim/machine/machine.h"
#include "sim/trace/recorder.h"
#include "traces/formats/format.h"
#include "traces/reader.h"

#include <atomic>
#include <memory>
#include <optional>
#include <random>
#include <string>

namespace sim::test {

/// What threads share, what each has to itself, words, and a film, which outlives the rest.
struct WorkMemory {
    isa::address_space space{std::uint64_t{1} << 26U};
    std::byte* shared = space.add("tree", -1, std::uint64_t{1} << 20U, true);
    std::byte* own = space.add("packets", -1, std::uint64_t{64} << 16U, true);
    std::byte* words = space.add("words", -1, 16384, true);
    std::byte* film = space.add("film", -1, std::uint64_t{1} << 19U);
};

/// Loads, stores, gathers, scatters, prefetches, discards and operations on shared words of all kinds, by a
/// seed; `count` of them.
inline void work(const WorkMemory& m, int worker, int count) {
    using namespace isa::timing;
    std::mt19937 random(static_cast<std::uint32_t>(worker) + 1);
    std::byte* const own = m.own + static_cast<std::ptrdiff_t>(worker % 64) * 65536;
    const auto at = [&](std::byte* base, std::uint32_t bytes) { return base + random() % (bytes / 4) * 4; };
    const auto site_of = [](std::uint32_t line) { return site{"work.h", line}; };
    std::array<std::int32_t, 64> index{};
    stamp s;
    std::byte* row = m.film + worker * 4096 % 262144;
    for (int i = 0; i < count; ++i) {
        if (i % 64 == 0) {
            set_phase(i / 64 % 2);
            set_kind(i / 128 % 2);
        }
        // One draw a statement: compilers evaluate operands in orders of their own.
        const std::uint64_t high = random(), low = random();
        const std::uint64_t lanes = (high << 32U | low) & (~std::uint64_t{0} >> (64 - ISA_WIDTH));
        for (std::int32_t& k : index)
            k = static_cast<std::int32_t>(random() % (i % 2 == 0 ? 512 : 16384));
        switch (random() % 16) {
        case 0:
        case 1: // in a row, for prefetchers
            for (int k = 0; k < 6; ++k)
                s = load(site_of(1), row += 64, 4, stamp{});
            if (row > m.film + 400000)
                row = m.film;
            break;
        case 2:
            s = load(site_of(2), at(m.shared, 1U << 20U), 8, s);
            break;
        case 3:
            store(site_of(3), at(i % 3 == 0 ? m.shared : own, i % 3 == 0 ? 65536 : 60000), 4, stamp{}, s);
            break;
        case 4:
            s = load_vector(site_of(4), at(own, 60000), ~std::uint64_t{0} >> (64 - ISA_WIDTH), stamp{},
                            stamp{});
            break;
        case 5: {
            const std::uint64_t some = lanes & random();
            s = load_vector(site_of(5), own + random() % 512 * 64, some, stamp{}, stamp{1, 1, 1});
            break;
        }
        case 6:
            store_vector(site_of(6), own + random() % 512 * 64, i % 2 == 0 ? lanes : 0, stamp{}, s, stamp{});
            break;
        case 7:
            s = gather(site_of(7), m.shared, index.data(), lanes, stamp{}, stamp{}, stamp{});
            break;
        case 8:
            scatter(site_of(8), own, index.data(), lanes & random(), stamp{}, stamp{}, s, stamp{});
            break;
        case 9:
            prefetch(site_of(9), at(m.shared, 1U << 20U), stamp{});
            break;
        case 10: {
            const auto bytes = static_cast<std::uint32_t>(100 + random() % 400);
            discard(site_of(10), own + random() % 400 * 100, bytes, stamp{});
            break;
        }
        case 11:
        case 12: { // a counter
            auto* word = reinterpret_cast<std::int32_t*>(m.words) + random() % 64;
            before_atomic(site_of(11), atomic::fetch_add, word, stamp{}, stamp{});
            ++*word;
            s = after_atomic(site_of(11), atomic::fetch_add, word, true);
            break;
        }
        case 13: {
            auto* word = reinterpret_cast<std::int32_t*>(m.words) + 64 + worker;
            before_atomic(site_of(12), atomic::store_release, word, stamp{}, stamp{});
            *word = i;
            s = after_atomic(site_of(12), atomic::store_release, word, true);
            break;
        }
        case 14: {
            auto* word = reinterpret_cast<std::int32_t*>(m.words) + 64 + worker;
            before_atomic(site_of(13), atomic::load_acquire, word, stamp{}, stamp{});
            s = after_atomic(site_of(13), atomic::load_acquire, word, false);
            break;
        }
        default:
            store(site_of(14), m.film + (worker * 4096 + i * 4) % 524288, 4, stamp{}, s);
        }
    }
}

struct Recorded {
    Report report;
    std::string trace; // bytes of a file
};

/// A run of all threads, and what was recorded of it.
inline Recorded record(const Config& config, int count, TraceSettings settings = {}) {
    settings.configuration = print_machine(config);
    WorkMemory memory;
    Recorded out;
    Recorder recorder(settings, config, traces::memory_sink(out.trace));
    RunOptions options;
    options.recorder = &recorder;
    const Machine machine(config);
    out.report = machine.run(
        memory.space, machine.threads(), {{"build", "shade"}, {"camera", "light"}},
        [&](int worker) { work(memory, worker, count); }, 1, options);
    recorder.finish();
    return out;
}

} // namespace sim::test
