// The host's caches: what is soon worked on may be brought there in advance.
#pragma once

#include <cstddef>

namespace sim {

inline void prefetch_lines(const void* begin, const void* end) {
    constexpr std::ptrdiff_t line_bytes = 64; // of most hosts; others bring some lines twice
#pragma GCC unroll 64
    for (const auto* p = static_cast<const std::byte*>(begin); p < static_cast<const std::byte*>(end);
         p += line_bytes)
        __builtin_prefetch(p);
}

} // namespace sim
