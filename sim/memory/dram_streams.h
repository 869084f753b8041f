// Streams of requests to try a memory with.
#pragma once

#include "sim/config/config.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace sim {

struct DramRequest {
    std::uint64_t address;
    bool write = false;
};
/// The next request at each call.
using DramStream = std::function<DramRequest()>;

struct DramStreamKind {
    const char *name, *meaning;
};
/// The first is the default.
const std::vector<DramStreamKind>& dram_stream_kinds();

/// Lines of the L2 in the memory's first `bytes` bytes; `stride`: bytes from one to the next where the kind
/// is strided. Throws ConfigError for an unknown kind or a memory of fewer than three lines.
DramStream make_dram_stream(const std::string& kind, const Config& config, std::uint64_t bytes,
                            std::uint64_t stride, std::uint64_t seed);

} // namespace sim
