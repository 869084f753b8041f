// Streams of references for caches: synthetic, and recorded.
#pragma once

#include "tests/program/quoted_argument.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace sim::test {

struct Reference {
    std::uint64_t address;
    std::uint32_t bytes;
    bool write;
};

/// Mostly near what was used before, now and then anywhere, sometimes in a row.
inline std::vector<Reference> synthetic(std::size_t count) {
    std::mt19937_64 random(11);
    std::vector<Reference> out(count);
    std::uint64_t at = 0, region = 0;
    for (Reference& r : out) {
        const std::uint64_t dice = random() % 100;
        if (dice < 2)
            region = random() % 64 * 65536;
        at = dice < 40 ? at + 8 : region + random() % (dice < 90 ? 4096U : 262144U) / 4 * 4;
        r = {at, 4, random() % 3 == 0};
    }
    return out;
}

/// Reads and writes of a Dinero trace (`label hexaddress bytes`); pages are numbered as they come, so that
/// addresses are small.
inline std::vector<Reference> read_trace(const std::string& file) {
    std::vector<Reference> out;
    std::map<std::uint64_t, std::uint64_t> pages;
    FILE* pipe = popen(("gzip -dc " + razor::quoted_argument(file)).c_str(), "r");
    if (pipe == nullptr)
        return out;
    int label = 0;
    std::uint64_t address = 0;
    std::uint32_t bytes = 0;
    while (std::fscanf(pipe, "%d %lx %u", &label, &address, &bytes) == 3)
        if (label != 2) {
            const std::uint64_t page = pages.try_emplace(address / 4096, pages.size()).first->second;
            out.push_back({page * 4096 + address % 4096, std::max(bytes, 1U), label == 1});
        }
    pclose(pipe);
    return out;
}

/// Where the recorded one may lie.
inline const char* const recorded_trace = RAZOR_SOURCE_DIR "/../shared/scenes/traces/simple_app.din.gz";

} // namespace sim::test
