// What parameters owe each other.
#include "sim/config/config.h"
#include "sim/config/error.h"
#include "sim/core/pairing.h"
#include "sim/memory/dram_mapping.h"
#include "sim/memory/dram_timing.h"
#include "sim/memory/queued_memory.h"

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
             fmt::format("{0}.size_bytes is {1}, which {0}.ways ({2}) of {3}-byte lines do not divide; make "
                         "it {4}",
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

void check_lanes(const std::string& what, const Config& config) {
    const LanesConfig& c = config.lanes;
    if (c.masked == "on" && config.core.gather != "lane")
        fail(what,
             fmt::format("lanes.masked is \"on\" where core.gather is \"{}\": what goes lane by lane is "
                         "a gather; make core.gather \"lane\"",
                         config.core.gather));
    const auto within = [&what](const char* part, integer references, integer instructions) {
        if (references > instructions)
            fail(what,
                 fmt::format("lanes.{0}_references is {1}, more than lanes.{0}_instructions, {2}, of which "
                             "they are a part; make that at least {1}",
                             part, references, instructions));
    };
    within("piece", c.piece_references, c.piece_instructions);
    within("load", c.load_references, c.load_instructions);
    within("store", c.store_references, c.store_instructions);
}

void check_core(const std::string& what, const Config& config) {
    check_lanes(what, config);
    const CoreConfig& c = config.core;
    if (std::string mistake = Pairing::mistake(c.pairing); !mistake.empty())
        fail(what, fmt::format("core.pairing \"{}\" {}", c.pairing, mistake));
    if (std::string mistake = shared_classes_mistake(c.shared_classes); !mistake.empty())
        fail(what, fmt::format("core.shared_classes \"{}\" {}", c.shared_classes, mistake));
    if (c.interleaved_values != 0 && c.broadcasts != "register")
        fail(what,
             fmt::format("core.interleaved_values is {}, which core.broadcasts \"{}\" does not know; make "
                         "that \"register\", or it 0",
                         c.interleaved_values, c.broadcasts));
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
    const integer line = config.last_cache().line_bytes;
    const unsigned last = config.cache_levels();
    if (burst > line)
        fail(what,
             fmt::format("a memory burst is {} bytes (memory.bus_bytes x memory.burst_length), more than "
                         "l{}.line_bytes, {}; lower either",
                         burst, last, line));
    if (c.burst_length < c.transfers_per_clock)
        fail(what, fmt::format("memory.burst_length is {}, less than memory.transfers_per_clock, {}; a burst "
                               "takes a clock at least: raise it",
                               c.burst_length, c.transfers_per_clock));
    if (c.row_bytes < line)
        fail(what,
             fmt::format("memory.row_bytes is {}, less than l{}.line_bytes, {}; a line must lie in one row",
                         c.row_bytes, last, line));
    if (std::string mistake = DramMapping::mistake(c); !mistake.empty())
        fail(what, fmt::format("memory.mapping \"{}\" {}", c.mapping, mistake));
    if (c.controller == "queued")
        if (std::string mistake = QueuedMemory::mistake(config); !mistake.empty())
            fail(what, mistake);
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

std::string level_name(unsigned level) {
    return fmt::format("l{}", level + 1);
}

/// Who shares the caches of a level: groups of whole caches of the level above, beyond the tiles of whole
/// tiles.
void check_share(const std::string& what, const Config& config, unsigned level) {
    const std::string name = level_name(level), above = level_name(level - 1);
    const integer cores = config.cores_sharing(level), upper = config.cores_sharing(level - 1);
    if (config.beyond_tiles(level)) {
        if (level == 1)
            fail(what,
                 fmt::format("l2.share is {}, more than chip.cores, {}: the L2 lies in a tile; share it by "
                             "at most as many, or put more cores into a tile",
                             cores, config.chip.cores));
        if (level + 1 != config.cache_levels())
            fail(what,
                 fmt::format("{0}.share is \"{1}\", beyond the tiles, where the last level alone may lie; "
                             "make it \"tile\", or {2}.size_bytes 0",
                             name, config.cache(level).share, level_name(level + 1)));
        if (cores % config.chip.cores != 0 || config.all_cores() % cores != 0)
            fail(what,
                 fmt::format("{}.share is {}, not so many whole tiles of chip.cores, {}, that the chip's "
                             "{} cores divide into; make it \"chip\" or a multiple",
                             name, cores, config.chip.cores, config.all_cores()));
        return;
    }
    if (config.chip.cores % cores != 0)
        fail(what, fmt::format("{}.share is {}, which does not divide chip.cores, {}; make it a divisor",
                               name, cores, config.chip.cores));
    if (cores % upper != 0)
        fail(what,
             fmt::format("{0}.share is {1} cores, which caches of {2}.share, {3} cores, do not divide; make "
                         "it a multiple",
                         name, cores, above, upper));
}

/// What inclusive and exclusive levels ask of themselves and of the level above.
void check_inclusion(const std::string& what, const Config& config, unsigned level) {
    const CacheConfig &c = config.cache(level), &upper = config.cache(level - 1);
    // A line on its way up to the L1 could not be recalled when a prefetch takes its place.
    for (unsigned at = 1; at <= level && c.inclusion == "inclusive" && !config.beyond_tiles(level); ++at)
        if (config.cache(at).prefetcher != "none")
            fail(what,
                 fmt::format("{0}.inclusion is \"inclusive\", but {1}.prefetcher is \"{2}\": within a tile "
                             "only the L1 may have a prefetcher above an inclusive level; make it \"none\"",
                             level_name(level), level_name(at), config.cache(at).prefetcher));
    if (c.inclusion != "exclusive")
        return;
    const std::string name = level_name(level), above = level_name(level - 1);
    const auto refuse = [&](const std::string& key, const std::string& value, const char* wanted) {
        fail(what, fmt::format("{}.inclusion is \"exclusive\", for which {} must be {}, not {}", name, key,
                               wanted, value));
    };
    if (config.beyond_tiles(level))
        refuse(name + ".share", c.share, "a tile or less");
    if (c.line_bytes != upper.line_bytes)
        fail(what, fmt::format("{0}.inclusion is \"exclusive\", for which {0}.line_bytes, {1}, must be "
                               "{2}.line_bytes, {3}",
                               name, c.line_bytes, above, upper.line_bytes));
    for (const auto& [key, of] : {std::pair(name, &c), std::pair(above, &upper)}) {
        if (of->write_policy != "back")
            refuse(key + ".write_policy", of->write_policy, "back");
        if (of->write_miss != "allocate")
            refuse(key + ".write_miss", of->write_miss, "allocate");
    }
    if (c.prefetcher != "none")
        refuse(name + ".prefetcher", c.prefetcher, "none");
}

void check_caches(const std::string& what, const Config& config) {
    const unsigned levels = config.cache_levels();
    for (unsigned level = levels; level < most_levels; ++level)
        if (config.cache(level).size_bytes != 0)
            fail(what,
                 fmt::format("{}.size_bytes is {}, but there is no level above it; give {}.size_bytes too",
                             level_name(level), config.cache(level).size_bytes, level_name(levels)));
    double lines = 0;
    for (unsigned level = 0; level < levels; ++level) {
        const CacheConfig& c = config.cache(level);
        const std::string name = level_name(level);
        check_cache(what, name.c_str(), c);
        if (level != 0) {
            const CacheConfig& upper = config.cache(level - 1);
            if (c.line_bytes < upper.line_bytes)
                fail(what,
                     fmt::format("{}.line_bytes is {}, less than {}.line_bytes, {}; make it at least that",
                                 name, c.line_bytes, level_name(level - 1), upper.line_bytes));
            check_share(what, config, level);
            check_inclusion(what, config, level);
            if (config.beyond_tiles(level) && c.prefetcher == "stride")
                fail(what, fmt::format("{0}.prefetcher is \"stride\", but beyond the tiles nobody knows the "
                                       "program's sites; make it \"next\" or \"none\"",
                                       name));
        }
        lines += static_cast<double>(config.all_cores() / config.cores_sharing(level)) *
                 static_cast<double>(c.size_bytes / c.line_bytes);
    }
    constexpr double most_lines = 1 << 27; // about a gigabyte of the host's memory for their tags
    if (lines > most_lines)
        fail(what,
             fmt::format("the caches of all cores and tiles hold {:.0f} lines together, more than the "
                         "{:.0f} that can be simulated; lower l1.size_bytes, l2.size_bytes, chip.cores or "
                         "chip.tiles",
                         lines, most_lines));
}

/// Entries and ways make a number of sets that is a power of two.
void check_tlb_sets(const std::string& what, const std::string& entries, integer n, const std::string& ways,
                    integer w) {
    if (w == 0 || (n % w == 0 && std::has_single_bit(static_cast<std::uint64_t>(n / w))))
        return;
    const integer below =
        n < w ? w : w * static_cast<integer>(std::bit_floor(static_cast<std::uint64_t>(n / w)));
    fail(what,
         fmt::format("{0} is {1}, which {2}, {3}, divides into no power of two of sets; make it {4}{5}, "
                     "or {2} 0",
                     entries, n, ways, w, below, n < w ? "" : fmt::format(" or {}", 2 * below)));
}

void check_tlb(const std::string& what, const Config& config) {
    const TlbConfig& c = config.tlb;
    if (!c.any()) {
        if (c.second_entries != 0)
            fail(what, fmt::format("tlb.second_entries is {}, but tlb.entries is 0: there is no TLB in front "
                                   "of it; give tlb.entries too",
                                   c.second_entries));
        return;
    }
    check_tlb_sets(what, "tlb.entries", c.entries, "tlb.ways", c.ways);
    if (c.second_entries == 0)
        return;
    check_tlb_sets(what, "tlb.second_entries", c.second_entries, "tlb.second_ways", c.second_ways);
    if (config.chip.cores % config.cores_sharing_tlb() != 0)
        fail(what,
             fmt::format("tlb.second_share is {}, which does not divide chip.cores, {}; make it a divisor",
                         config.cores_sharing_tlb(), config.chip.cores));
}

void check_network(const std::string& what, const Config& config) {
    const integer columns = config.network.columns, tiles = config.chip.tiles;
    if (config.network.topology == "mesh" && columns != 0 && tiles % columns != 0)
        fail(what,
             fmt::format("network.columns is {}, which does not divide chip.tiles, {}: every row of a mesh "
                         "is full; make it a divisor, or 0",
                         columns, tiles));
    const integer buses = config.network.buses;
    if (config.network.bus() && tiles % buses != 0)
        fail(what, fmt::format("network.buses is {}, which does not divide chip.tiles, {}: every bus has as "
                               "many; make it a divisor",
                               buses, tiles));
}

/// What coherence of plain data needs of the caches and of memory.
void check_coherence(const std::string& what, const Config& config) {
    if (!config.coherence.kept())
        return;
    const auto refuse = [&](const std::string& key, const std::string& value, const std::string& wanted) {
        fail(what, fmt::format("coherence.plain is \"{}\", for which {} must be {}, not {}; make it "
                               "that, or coherence.plain \"none\"",
                               config.coherence.plain, key, wanted, value));
    };
    const unsigned levels = config.tile_levels(), last = config.cache_levels() - 1;
    for (unsigned level = 1; level < levels; ++level)
        if (config.cache(level).inclusion != "inclusive")
            refuse(level_name(level) + ".inclusion", config.cache(level).inclusion, "inclusive");
    const CacheConfig& own = config.cache(levels - 1);
    if (own.write_policy != "back")
        refuse(level_name(levels - 1) + ".write_policy", own.write_policy, "back");
    if (own.write_miss != "allocate")
        refuse(level_name(levels - 1) + ".write_miss", own.write_miss, "allocate");
    if (config.coherence.snoops() && !config.network.bus())
        refuse("network.topology", config.network.topology, "bus");
    if (config.beyond_tiles(last) && config.cores_sharing(last) != config.all_cores())
        refuse(level_name(last) + ".share", config.cache(last).share, "chip");
    const CoherenceConfig& c = config.coherence;
    if (!c.snoops() && c.directory_entries % c.directory_ways != 0)
        fail(what, fmt::format("coherence.directory_entries is {}, which is no multiple of "
                               "coherence.directory_ways, {}: all sets have as many; make it one",
                               c.directory_entries, c.directory_ways));
}

/// What the reference mode stands for.
void check_mode(const std::string& what, const Config& config) {
    if (config.sim.mode != "reference")
        return;
    const auto refuse = [&](const char* key, const std::string& value, const char* wanted) {
        fail(what, fmt::format("{} is {}, for which sim.mode \"reference\" stands no more: there it is {}; "
                               "make it that, or sim.mode \"fast\"",
                               key, value, wanted));
    };
    if (config.memory.controller != "queued")
        refuse("memory.controller", config.memory.controller, "queued");
    if (config.sim.quantum > 1)
        refuse("sim.quantum", fmt::format("{}", config.sim.quantum), "0 or 1");
    if (config.sim.window != 0)
        refuse("sim.window", fmt::format("{}", config.sim.window), "0");
}

} // namespace

void check_consistency(const Config& c, const std::string& what) {
    check_caches(what, c);
    check_core(what, c);
    check_memory(what, c);
    check_tlb(what, c);
    check_network(what, c);
    check_mode(what, c);
    check_coherence(what, c);
    if (c.all_threads() > 65536)
        fail(what, fmt::format("chip.tiles x chip.cores x chip.threads is {}; it must be at most 65536",
                               c.all_threads()));
}

} // namespace sim
