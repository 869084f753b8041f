// What parameters owe each other.
#include "sim/config/config.h"
#include "sim/config/error.h"

#include <fmt/core.h>

#include <bit>

namespace sim {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& message) {
    throw ConfigError(fmt::format("{}: {}", what, message));
}

void check_cache(const std::string& what, const char* name, integer size, integer ways, integer line) {
    if (size % (ways * line) != 0) {
        const auto sets_below = static_cast<std::uint64_t>(size / (ways * line));
        const auto set = static_cast<std::uint64_t>(ways * line);
        const std::uint64_t above = std::bit_ceil(sets_below + 1) * set;
        fail(what,
             fmt::format("{}.size_bytes is {}, which {} ways of {}-byte lines do not divide; make it {}",
                         name, size, ways, line,
                         sets_below == 0 ? fmt::format("{}", above)
                                         : fmt::format("{} or {}", std::bit_floor(sets_below) * set, above)));
    }
    auto sets = static_cast<std::uint64_t>(size / (ways * line));
    if (!std::has_single_bit(sets))
        fail(what,
             fmt::format(
                 "{0}.size_bytes is {1}, which makes {2} sets; the number of sets must be a power of two: "
                 "make it {3} or {4}, or change {0}.ways",
                 name, size, sets, std::bit_floor(sets) * static_cast<std::uint64_t>(ways * line),
                 std::bit_ceil(sets) * static_cast<std::uint64_t>(ways * line)));
}

} // namespace

void check_consistency(const Config& c, const std::string& what) {
    check_cache(what, "l1", c.l1.size_bytes, c.l1.ways, c.l1.line_bytes);
    check_cache(what, "l2", c.l2.size_bytes, c.l2.ways, c.l2.line_bytes);
    if (c.l2.line_bytes < c.l1.line_bytes)
        fail(what, fmt::format("l2.line_bytes is {}, less than l1.line_bytes, {}; make it at least that",
                               c.l2.line_bytes, c.l1.line_bytes));
    integer burst = c.memory.bus_bytes * c.memory.burst_length;
    if (burst > c.l2.line_bytes)
        fail(what,
             fmt::format("a memory burst is {} bytes (memory.bus_bytes x memory.burst_length), more than "
                         "l2.line_bytes, {}; lower either",
                         burst, c.l2.line_bytes));
    if (c.memory.row_bytes < c.l2.line_bytes)
        fail(what,
             fmt::format("memory.row_bytes is {}, less than l2.line_bytes, {}; a line must lie in one row",
                         c.memory.row_bytes, c.l2.line_bytes));
    if (c.memory.tREFI != 0 && c.memory.tRFC + c.memory.tRP + c.memory.tRCD >= c.memory.tREFI)
        fail(what,
             fmt::format(
                 "memory.tREFI is {}, which leaves no time between refreshes of memory.tRFC, {}; raise it",
                 c.memory.tREFI, c.memory.tRFC));
    if (c.chip.cores * c.chip.threads > 65536)
        fail(what, fmt::format("chip.cores x chip.threads is {}; it must be at most 65536",
                               c.chip.cores * c.chip.threads));
}

} // namespace sim
