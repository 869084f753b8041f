// What parameters owe each other.
#include "sim/config/config.h"
#include "sim/config/error.h"
#include "sim/core/pairing.h"
#include "sim/memory/dram_mapping.h"
#include "sim/memory/dram_timing.h"

#include <fmt/core.h>

#include <bit>

namespace sim {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& message) {
    throw ConfigError(fmt::format("{}: {}", what, message));
}

void check_cache(const std::string& what, const char* name, const CacheConfig& c) {
    const integer size = c.size_bytes, ways = c.ways, line = c.line_bytes;
    if (c.replacement == "plru" && !std::has_single_bit(static_cast<std::uint64_t>(ways)))
        fail(what,
             fmt::format("{0}.ways is {1}; {0}.replacement \"plru\" needs a power of two: make it {2} or {3}",
                         name, ways, std::bit_floor(static_cast<std::uint64_t>(ways)),
                         std::bit_ceil(static_cast<std::uint64_t>(ways))));
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

void at_least(const std::string& what, const char* longer, integer a, const char* shorter, integer b) {
    if (a < b)
        fail(what, fmt::format("memory.{0} is {1}, less than memory.{2}, {3}; make it at least that", longer,
                               a, shorter, b));
}

void check_core(const std::string& what, const Config& config) {
    const CoreConfig& c = config.core;
    if (std::string mistake = Pairing::mistake(c.pairing); !mistake.empty())
        fail(what, fmt::format("core.pairing \"{}\" {}", c.pairing, mistake));
    if (std::string mistake = shared_classes_mistake(c.shared_classes); !mistake.empty())
        fail(what, fmt::format("core.shared_classes \"{}\" {}", c.shared_classes, mistake));
    if (c.predictor == "counters" && c.predictor_history > 10)
        fail(what,
             fmt::format(
                 "core.predictor_history is {}; a table of unlimited size takes at most 10: lower it, or "
                 "take predictor gshare",
                 c.predictor_history));
    if (c.predictor == "gshare" && integer{1} << c.predictor_history > c.predictor_entries)
        fail(what, fmt::format(
                       "core.predictor_history is {}, more bits than core.predictor_entries, {}, has places "
                       "for; lower it, or make those {}",
                       c.predictor_history, c.predictor_entries, integer{1} << c.predictor_history));
    if (config.chip.cores % c.shared_cores != 0)
        fail(what,
             fmt::format("core.shared_cores is {}, which does not divide chip.cores, {}: units are shared "
                         "within a tile; make it a divisor",
                         c.shared_cores, config.chip.cores));
}

void check_memory(const std::string& what, const Config& config) {
    const MemoryConfig& c = config.memory;
    integer burst = c.bus_bytes * c.burst_length;
    if (burst > config.l2.line_bytes)
        fail(what,
             fmt::format("a memory burst is {} bytes (memory.bus_bytes x memory.burst_length), more than "
                         "l2.line_bytes, {}; lower either",
                         burst, config.l2.line_bytes));
    if (c.burst_length < c.transfers_per_clock)
        fail(what, fmt::format("memory.burst_length is {}, less than memory.transfers_per_clock, {}; a burst "
                               "takes a clock at least: raise it",
                               c.burst_length, c.transfers_per_clock));
    if (c.row_bytes < config.l2.line_bytes)
        fail(what,
             fmt::format("memory.row_bytes is {}, less than l2.line_bytes, {}; a line must lie in one row",
                         c.row_bytes, config.l2.line_bytes));
    if (std::string mistake = DramMapping::mistake(c); !mistake.empty())
        fail(what, fmt::format("memory.mapping \"{}\" {}", c.mapping, mistake));
    at_least(what, "tCCD_L", c.tCCD_L, "tCCD_S", c.tCCD_S);
    at_least(what, "tRRD_L", c.tRRD_L, "tRRD_S", c.tRRD_S);
    at_least(what, "tWTR_L", c.tWTR_L, "tWTR_S", c.tWTR_S);
    at_least(what, "tRC", c.tRC, "tRAS", c.tRAS);
    at_least(what, "write_queue", c.write_queue, "write_high", c.write_high);
    if (c.write_low >= c.write_high)
        fail(what, fmt::format("memory.write_low is {}, not less than memory.write_high, {}; lower it",
                               c.write_low, c.write_high));
    if (c.refresh == "per-bank" && c.refresh_postponed != 0)
        fail(what, fmt::format("memory.refresh_postponed is {}, but refreshes of single banks are not put "
                               "off; make it 0 or memory.refresh all-bank",
                               c.refresh_postponed));
    DramTiming t(c);
    integer turns = c.ranks * c.bank_groups * c.banks;
    auto apart = std::max({c.tRREFD, c.tRRD_L, c.tRP}) + 2;
    if (c.refresh == "per-bank" && c.tREFI != 0 &&
        (c.tREFI / turns < apart || c.tREFI < c.tRFCpb + static_cast<integer>(t.around_refresh()) + 64))
        fail(what,
             fmt::format("memory.tREFI is {}, too short to refresh {} banks in turn; raise "
                         "it to {} or more",
                         c.tREFI, turns,
                         std::max(turns * apart, c.tRFCpb + static_cast<integer>(t.around_refresh()) + 64)));
    auto needed = static_cast<integer>(t.blocked_by_refresh()) + 64;
    if (c.tREFI != 0 && c.tREFI / c.ranks < needed)
        fail(what,
             fmt::format("memory.tREFI is {}, which leaves no time between refreshes of {} ranks that take "
                         "{} clocks each with what comes before and after; raise it to {} or more",
                         c.tREFI, c.ranks, needed, needed * c.ranks));
}

} // namespace

void check_consistency(const Config& c, const std::string& what) {
    check_cache(what, "l1", c.l1);
    check_cache(what, "l2", c.l2);
    if (c.l2.line_bytes < c.l1.line_bytes)
        fail(what, fmt::format("l2.line_bytes is {}, less than l1.line_bytes, {}; make it at least that",
                               c.l2.line_bytes, c.l1.line_bytes));
    check_core(what, c);
    check_memory(what, c);
    constexpr double most_lines = 1 << 27; // about a gigabyte of the host's memory for their tags
    double lines =
        static_cast<double>(c.all_cores()) * static_cast<double>(c.l1.size_bytes / c.l1.line_bytes) +
        static_cast<double>(c.chip.tiles) * static_cast<double>(c.l2.size_bytes / c.l2.line_bytes);
    if (lines > most_lines)
        fail(what,
             fmt::format(
                 "the caches of all cores and tiles hold {:.0f} lines together, more than the {:.0f} that "
                 "can be simulated; lower l1.size_bytes, l2.size_bytes, chip.cores or chip.tiles",
                 lines, most_lines));
    if (c.all_threads() > 65536)
        fail(what, fmt::format("chip.tiles x chip.cores x chip.threads is {}; it must be at most 65536",
                               c.all_threads()));
}

} // namespace sim
