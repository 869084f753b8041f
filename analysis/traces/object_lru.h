// LRU caches of objects of any size, as of storage and of the web: capacity in bytes.
#pragma once

#include "analysis/traces/line_map.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace analysis {

/// What is touched comes to the front; the last ones go until all fit. A hit takes the object's new size; an
/// object larger than the cache is never in it.
class ObjectLru {
public:
    explicit ObjectLru(std::uint64_t capacity) : capacity_(capacity) {}
    /// Whether it was there.
    bool touch(std::uint64_t object, std::uint64_t bytes);
    std::uint64_t bytes() const { return held_; }

private:
    static constexpr std::uint32_t none = LineMap::none;
    struct Node {
        std::uint64_t object = 0, bytes = 0;
        std::uint32_t before = none, after = none;
    };
    void unlink(std::uint32_t at);
    void drop(std::uint32_t at);

    std::uint64_t capacity_, held_ = 0;
    LineMap places_; // of objects: nodes
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> free_;
    std::uint32_t front_ = none, back_ = none;
};

} // namespace analysis
