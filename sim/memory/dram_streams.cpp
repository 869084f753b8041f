#include "sim/memory/dram_streams.h"

#include "sim/config/error.h"
#include "sim/memory/dram_mapping.h"

#include <fmt/core.h>

#include <random>

namespace sim {
namespace {

/// a[i] = b[i] op c[i], in arrays one after the other: two reads, a write, the next line.
DramStream triad(std::uint64_t lines, std::uint64_t line) {
    return [third = lines / 3, line, i = std::uint64_t{0}, part = 0U]() mutable {
        DramRequest r{(third * part + i) * line, part == 2};
        part = (part + 1) % 3;
        i = part == 0 ? (i + 1) % third : i;
        return r;
    };
}

/// Random rows and columns of the bank that holds address 0, by whatever mapping.
DramStream hot_bank(const Config& c, std::uint64_t lines, std::uint64_t line, std::uint64_t seed) {
    return [map = DramMapping(c.memory), random = std::mt19937_64(seed), lines, line]() mutable {
        const DramPlace first = map.locate(0);
        for (;;) {
            std::uint64_t address = random() % lines * line;
            DramPlace p = map.locate(address);
            if (p.channel == first.channel && p.rank == first.rank && p.group == first.group &&
                p.bank == first.bank)
                return DramRequest{address};
        }
    };
}

} // namespace

const std::vector<DramStreamKind>& dram_stream_kinds() {
    static const std::vector<DramStreamKind> kinds = {
        {"sequential", "reads of one line after the other"},
        {"random", "reads of random lines"},
        {"two-to-one", "random lines, two read, one written"},
        {"triad", "three arrays in step, two read, one written"},
        {"strided", "reads of lines a stride apart"},
        {"hot-bank", "reads of random rows of one bank"},
    };
    return kinds;
}

DramStream make_dram_stream(const std::string& kind, const Config& c, std::uint64_t bytes,
                            std::uint64_t stride, std::uint64_t seed) {
    auto line = static_cast<std::uint64_t>(c.last_cache().line_bytes);
    std::uint64_t lines = bytes / line;
    if (lines < 3)
        throw ConfigError(fmt::format("{} bytes hold no three lines of {} bytes; raise them", bytes, line));
    if (kind == "random")
        return [random = std::mt19937_64(seed), lines, line]() mutable {
            return DramRequest{random() % lines * line};
        };
    if (kind == "two-to-one")
        return [random = std::mt19937_64(seed), lines, line, i = 0U]() mutable {
            return DramRequest{random() % lines * line, ++i % 3 == 0};
        };
    if (kind == "triad")
        return triad(lines, line);
    if (kind == "hot-bank")
        return hot_bank(c, lines, line, seed);
    if (kind == "sequential" || kind == "strided")
        return [lines, line, step = kind == "strided" ? stride : line, next = std::uint64_t{0}]() mutable {
            DramRequest r{next};
            next = (next + step) % (lines * line);
            return r;
        };
    std::string all;
    for (const DramStreamKind& k : dram_stream_kinds())
        all += (all.empty() ? "" : ", ") + std::string(k.name);
    throw ConfigError(fmt::format("\"{}\" is no stream of requests; write one of {}", kind, all));
}

} // namespace sim
