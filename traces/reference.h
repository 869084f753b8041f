// A memory reference, and a block of them as columns.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace traces {

/// What a reference is. `modify` reads and writes; `write_back` is a dirty line that leaves a cache,
/// `write_through` a write that a cache passes on, `flush` says that a line's contents need not be kept.
enum class Kind : std::uint8_t { read, write, modify, fetch, prefetch, write_back, write_through, flush };
inline constexpr std::array<const char*, 8> kind_names = {"read",     "write",      "modify",        "fetch",
                                                          "prefetch", "write_back", "write_through", "flush"};

/// All of a reference that few others differ in: what a block keeps in a table.
struct Class {
    std::uint64_t site = 0; // a number in Description::sites, from 1 on, or an address; 0: unknown
    std::uint32_t size = 0; // bytes; 0: unknown
    std::uint16_t structure = 0, phase = 0, work = 0; // numbers in the tables of the description
    Kind kind = Kind::read;
    friend bool operator==(const Class&, const Class&) = default;
};

struct Reference {
    std::uint64_t time = 0, address = 0;
    std::uint32_t stream = 0;
    Class what{};
};

/// The references [begin, end) of a block are of one stream, in its order.
struct Segment {
    std::uint32_t stream = 0;
    std::size_t begin = 0, end = 0;
};

/// Some references of all streams, those of one stream side by side. Those of later blocks come later in
/// their streams.
struct Block {
    std::vector<Segment> segments; // ascending streams
    std::vector<std::uint64_t> times, addresses;
    std::vector<std::uint32_t> classes; // numbers in `table`
    std::vector<Class> table;

    std::size_t size() const { return addresses.size(); }
    const Class& what(std::size_t i) const { return table[classes[i]]; }
    void clear() {
        segments.clear();
        times.clear();
        addresses.clear();
        classes.clear();
        table.clear();
    }
};

/// The most references that a block may hold.
inline constexpr std::size_t most_references = std::size_t{1} << 20;

} // namespace traces
