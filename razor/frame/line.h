// What frame memory is counted in: whole cache lines.
#pragma once

#include <cstdint>

namespace razor {

inline constexpr int line_bytes = 64;
struct alignas(line_bytes) Line {
    std::int32_t word[line_bytes / 4];
};

} // namespace razor
