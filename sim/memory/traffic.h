// Traffic by data structure, level of its contents, kind of work and phase: a cell of plain counters for each
// combination. A line written back counts for the structure and level it belongs to and for the kind and
// phase that evicted it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace sim {

/// A level counts what arrives at it. Bytes are counts times the line of the level above, from
/// the L2 on.
struct Traffic {
    std::uint64_t l1_reads = 0, l1_writes = 0, l1_misses = 0, l1_write_backs = 0;
    std::uint64_t l2_reads = 0, l2_writes = 0, l2_misses = 0, l2_write_backs = 0;
    std::uint64_t memory_reads = 0, memory_writes = 0;
    std::uint64_t l3_reads = 0, l3_writes = 0, l3_misses = 0, l3_write_backs = 0;
    std::uint64_t l4_reads = 0, l4_writes = 0, l4_misses = 0, l4_write_backs = 0;
    std::uint64_t l5_reads = 0, l5_writes = 0, l5_misses = 0, l5_write_backs = 0;
};

/// Where a cache of a level counts.
struct TrafficOfLevel {
    std::uint64_t Traffic::*reads, Traffic::*writes, Traffic::*misses, Traffic::*write_backs;
};
inline constexpr std::array<TrafficOfLevel, 5> traffic_of_level = {{
    {&Traffic::l1_reads, &Traffic::l1_writes, &Traffic::l1_misses, &Traffic::l1_write_backs},
    {&Traffic::l2_reads, &Traffic::l2_writes, &Traffic::l2_misses, &Traffic::l2_write_backs},
    {&Traffic::l3_reads, &Traffic::l3_writes, &Traffic::l3_misses, &Traffic::l3_write_backs},
    {&Traffic::l4_reads, &Traffic::l4_writes, &Traffic::l4_misses, &Traffic::l4_write_backs},
    {&Traffic::l5_reads, &Traffic::l5_writes, &Traffic::l5_misses, &Traffic::l5_write_backs},
}};

struct TrafficColumn {
    const char* name;
    std::uint64_t Traffic::*count;
    const char* meaning;
    unsigned level = 0; // that it needs, from 0; memory: 0
};
inline constexpr std::array<TrafficColumn, 22> traffic_columns = {{
    {"l1_reads", &Traffic::l1_reads, "L1 read accesses: one a machine load and line it touches"},
    {"l1_writes", &Traffic::l1_writes, "L1 write accesses"},
    {"l1_misses", &Traffic::l1_misses, "L1 accesses that began a fill from the L2"},
    {"l1_write_backs", &Traffic::l1_write_backs, "dirty lines that left an L1"},
    {"l2_reads", &Traffic::l2_reads, "lines asked of the L2, read-modify-writes included"},
    {"l2_writes", &Traffic::l2_writes, "lines written back to the L2, and released words"},
    {"l2_misses", &Traffic::l2_misses, "L2 reads and writes that did not find their line"},
    {"l2_write_backs", &Traffic::l2_write_backs, "dirty lines that left the L2"},
    {"l3_reads", &Traffic::l3_reads, "lines asked of the L3", 2},
    {"l3_writes", &Traffic::l3_writes, "lines and writes sent down to the L3", 2},
    {"l3_misses", &Traffic::l3_misses, "L3 reads and writes that did not find their line", 2},
    {"l3_write_backs", &Traffic::l3_write_backs, "dirty lines that left the L3", 2},
    {"l4_reads", &Traffic::l4_reads, "lines asked of the L4", 3},
    {"l4_writes", &Traffic::l4_writes, "lines and writes sent down to the L4", 3},
    {"l4_misses", &Traffic::l4_misses, "L4 reads and writes that did not find their line", 3},
    {"l4_write_backs", &Traffic::l4_write_backs, "dirty lines that left the L4", 3},
    {"l5_reads", &Traffic::l5_reads, "lines asked of the L5", 4},
    {"l5_writes", &Traffic::l5_writes, "lines and writes sent down to the L5", 4},
    {"l5_misses", &Traffic::l5_misses, "L5 reads and writes that did not find their line", 4},
    {"l5_write_backs", &Traffic::l5_write_backs, "dirty lines that left the L5", 4},
    {"memory_reads", &Traffic::memory_reads, "lines read from memory"},
    {"memory_writes", &Traffic::memory_writes, "lines written to memory"},
}};

inline bool is_empty(const Traffic& t) {
    for (const TrafficColumn& c : traffic_columns)
        if (t.*c.count != 0)
            return false;
    return true;
}

/// A column is a kind of work and a phase: kind x phases + phase.
inline constexpr std::size_t max_columns = 64;
struct TrafficRow {
    std::size_t structure;
    std::optional<int> level; // of what lies there, where that is known
    std::size_t column;
    Traffic traffic;
};
/// Lines that were accessed in L1s under these columns, a bit each, and under no other.
struct TouchedLines {
    std::size_t structure;
    std::uint64_t columns;
    std::uint64_t lines;
};

} // namespace sim
