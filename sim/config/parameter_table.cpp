// Every parameter with its unit, preset, bounds and meaning.
#include "sim/config/parameter_table.h"

#include "sim/config/memory_presets.h"

#include <fmt/core.h>

#include <tuple>

namespace sim {
namespace {

constexpr integer kibi = 1024;

struct Table {
    std::vector<Parameter> rows;

    template <class Section, class Part>
    void add(std::string key, Section Config::*section, integer Part::*member, std::string unit,
             integer preset, integer least, integer most, std::string meaning, bool power_of_two = false) {
        auto at = [section, member](Config& c) -> integer& { return (c.*section).*member; };
        rows.push_back({std::move(key), std::move(unit), std::move(meaning),
                        IntegerKind{at, least, most, power_of_two, preset}});
    }
    template <class Section>
    void add(std::string key, Section Config::*section, double Section::*member, std::string unit,
             double preset, double least, double most, std::string meaning) {
        auto at = [section, member](Config& c) -> double& { return (c.*section).*member; };
        rows.push_back(
            {std::move(key), std::move(unit), std::move(meaning), RealKind{at, least, most, preset}});
    }
    template <class Section, class Part>
    void add(std::string key, Section Config::*section, std::string Part::*member,
             std::vector<std::string> choices, std::string meaning, integer most_number = 0) {
        auto at = [section, member](Config& c) -> std::string& { return (c.*section).*member; };
        rows.push_back({std::move(key), "", std::move(meaning),
                        ChoiceKind{at, std::move(choices), most_number, nullptr, nullptr}});
    }
    /// Any text; what it must be is for check_consistency to say.
    template <class Section>
    void add_text(std::string key, Section Config::*section, std::string Section::*member, std::string preset,
                  std::string meaning) {
        auto at = [section, member](Config& c) -> std::string& { return (c.*section).*member; };
        rows.push_back({std::move(key), "", std::move(meaning), TextKind{at, std::move(preset)}});
    }
    void add_class(const char* table, std::array<integer, class_count> Config::*values, int index,
                   integer preset, integer least, std::string meaning, const char* unit = "cycles") {
        auto i = static_cast<std::size_t>(index);
        auto at = [values, i](Config& c) -> integer& { return (c.*values)[i]; };
        rows.push_back({fmt::format("{}.{}", table, class_names[i]), unit, std::move(meaning),
                        IntegerKind{at, least, 1000, false, preset}});
    }
};

void add_chip(Table& t) {
    using C = ChipConfig;
    auto s = &Config::chip;
    t.add("chip.clock_ps", s, &C::clock_ps, "ps", 1000, 50, 1000000, "period of the cores' clock");
    t.add("chip.tiles", s, &C::tiles, "", 1, 1, 1024,
          "tiles: cores and caches that run by themselves for a window");
    t.add("chip.cores", s, &C::cores, "", 4, 1, 1024, "cores of a tile, each with its own L1");
    t.add("chip.threads", s, &C::threads, "", 2, 1, 64, "hardware threads of a core");
    t.add("chip.placement", s, &C::placement, {"spread", "pack"},
          "spread: consecutive workers on different tiles, then cores; pack: a core's threads filled first, "
          "then a tile's");
}

void add_core(Table& t) {
    using C = CoreConfig;
    auto s = &Config::core;
    t.add("core.issue_width", s, &C::issue_width, "instructions/cycle", 1, 1, 16,
          "issue slots, shared by the threads");
    t.add_text(
        "core.pairing", s, &C::pairing, "any",
        "any: each slot takes any instruction; else ports, apart by |, that take one a cycle of the "
        "kinds they list (any, scalar, vector, memory, load, store, branch, classes, vector.CLASS ...)");
    t.add_text("core.shared_classes", s, &C::shared_classes, "none",
               "classes that share one unit, which takes one instruction an interval; none: no such unit");
    t.add("core.shared_cores", s, &C::shared_cores, "cores", 1, 1, 1024,
          "neighbouring cores of a tile that share a unit of core.shared_classes");
    t.add("core.lanes", s, &C::lanes, "lanes", 4, 1, 64,
          "32-bit lanes of the SIMD unit; wider operations are split", true);
    t.add("core.window", s, &C::window, "operations", 1, 1, 1024,
          "operation i issues no earlier than operation i - window; 1: source order");
    t.add("core.vector_registers", s, &C::vector_registers, "values", 0, 0, 512,
          "vector values of full logical width that a thread's registers hold; 0: unlimited");
    t.add("core.broadcasts", s, &C::broadcasts, {"value", "register"},
          "what a value with the same scalar in all lanes takes of the registers: as much as any value; "
          "register: one machine register, and one store or load where it is spilled");
    t.add("core.interleaved_values", s, &C::interleaved_values, "values", 0, 0, 64,
          "how many of those used since the last branch or operation across lanes stay in registers "
          "besides, as compilers take such code a sub-vector at a time in part; with core.broadcasts = "
          "register");
    t.add("core.memory_operands", s, &C::memory_operands, "operands", 0, 0, 3,
          "of an operation, that may come from the stack with it: they take no load instruction");
    t.add("core.spill_slots", s, &C::spill_slots, "values", 32, 1, 4096,
          "stack slots that spilled values share");
    t.add("core.scalar_overhead", s, &C::scalar_overhead, "instructions", 0, 0, 100,
          "integer and call overhead charged with every load and branch");
    t.add("core.scalar_moves", s, &C::scalar_moves, "instructions", 0, 0, 16,
          "charged with every scalar computation: moves of scalars between registers, to the stack and back");
    t.add("core.vector_moves", s, &C::vector_moves, "instructions", 0, 0, 16,
          "charged with every machine instruction of a vector computation: copies of registers that "
          "two-operand forms "
          "overwrite, constants");
    t.add("core.predictor", s, &C::predictor,
          {"counters", "bimodal", "gshare", "taken", "not_taken", "none", "perfect"},
          "counters: two bits a branch site (line of source) and history, no two shared; bimodal: two bits a "
          "site, "
          "gshare: a site and history, in tables of limited size; taken, not_taken: always; none: branches "
          "wait; "
          "perfect: never wrong");
    t.add("core.predictor_history", s, &C::predictor_history, "branches", 0, 0, 20,
          "outcomes of the thread's last branches that choose the counter (counters, gshare)");
    t.add("core.predictor_entries", s, &C::predictor_entries, "counters", 4096, 1, 1 << 20,
          "counters of a core (bimodal, gshare)", true);
    t.add("core.mispredict_cycles", s, &C::mispredict_cycles, "cycles", 5, 0, 1000,
          "from a branch's outcome to the first operation after a wrong prediction");
    t.add("core.switch_policy", s, &C::switch_policy, {"fine", "stall"},
          "fine: any thread takes any free slot; stall: a thread keeps the core until it stalls");
    t.add("core.switch_cycles", s, &C::switch_cycles, "cycles", 0, 0, 1000,
          "lost when another thread takes the core (policy stall)");
    t.add("core.gather", s, &C::gather, {"line", "lane"},
          "line: one L1 access a distinct line of a sub-vector; lane: a load instruction for every active "
          "lane");
    t.add("core.address_folding", s, &C::address_folding, {"off", "on"},
          "on: loads and stores add base and index of their address themselves; only sums used otherwise are "
          "instructions");
    t.add("core.store_buffer", s, &C::store_buffer, "entries", 0, 0, 256,
          "stores of a thread on their way to the L1, in order, forwarded to its loads; 0: as many as there "
          "are, "
          "loads wait for the line");
    t.add("core.skip_idle", s, &C::skip_idle, {"off", "on"},
          "on: masked loads, stores, gathers and scatters issue only the sub-vectors with an active lane, "
          "one at "
          "the least (arithmetic has no masks: idle lanes compute)");
    t.add("core.spin_period", s, &C::spin_period, "cycles", 16, 1, 100000,
          "between two looks of a waiting thread, of two instructions each; no less than these take if all "
          "threads of a core take turns");
}

void add_lanes(Table& t) {
    using C = LanesConfig;
    auto s = &Config::lanes;
    t.add("lanes.masked", s, &C::masked, {"off", "on"},
          "on: masked loads and stores of consecutive lanes go lane by lane as well, as gathers and scatters "
          "do (core.gather = lane)");
    t.add("lanes.scatter", s, &C::scatter, {"off", "on"},
          "on: scatters go lane by lane even where gathers do not (core.gather = line)");
    t.add("lanes.shuffle", s, &C::shuffle, {"off", "on"},
          "on: permutations and compressions go lane by lane through the thread's stack, as gathers of all "
          "lanes");
    t.add(
        "lanes.idle", s, &C::idle, {"skip", "test"},
        "skip: lane by lane, idle lanes take nothing; test: each takes what a lane that is loaded by itself "
        "does, but the load");
    t.add("lanes.piece_instructions", s, &C::piece_instructions, "instructions", 0, 0, 64,
          "of a sub-vector that goes lane by lane, beside what its lanes take");
    t.add("lanes.piece_references", s, &C::piece_references, "references", 0, 0, 64,
          "of these, loads and stores of the thread's stack");
    t.add("lanes.gather_instructions", s, &C::gather_instructions, "instructions", 0, 0, 64,
          "of a sub-vector that is gathered by one instruction (core.gather = line), beside that");
    t.add("lanes.load_instructions", s, &C::load_instructions, "instructions", 0, 0, 64,
          "of a lane that is loaded by itself, beside the load");
    t.add("lanes.load_references", s, &C::load_references, "references", 0, 0, 64,
          "of these, loads and stores of the thread's stack");
    t.add("lanes.store_instructions", s, &C::store_instructions, "instructions", 0, 0, 64,
          "of an active lane that is stored by itself, beside the store");
    t.add("lanes.store_references", s, &C::store_references, "references", 0, 0, 64,
          "of these, loads and stores of the thread's stack");
}

void add_classes(Table& t) {
    constexpr std::array<integer, class_count> latency = {1, 3, 4, 4, 4, 16, 16, 2, 4,
                                                          1, 1, 2, 2, 6, 2,  1,  1};
    constexpr std::array<integer, class_count> interval = {1, 1, 1, 1, 1, 8, 8, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    for (int i = 0; i < class_count; ++i)
        t.add_class("latency", &Config::latency, i, latency[static_cast<std::size_t>(i)], 0,
                    "from a sub-vector's issue to its result");
    for (int i = 0; i < class_count; ++i)
        t.add_class("interval", &Config::interval, i, interval[static_cast<std::size_t>(i)], 1,
                    "a sub-vector keeps the core's one unit of this class; 1: pipelined, as many as issue");
    for (int i = 0; i < address_class; ++i)
        t.add_class("instructions", &Config::instructions, i, 1, 1,
                    "that a sub-vector of a vector operation takes; 1: the instruction set has it",
                    "instructions");
}

/// What all caches have, whatever their place.
template <class Section> void add_policies(Table& t, const std::string& level, Section Config::*section) {
    using C = CacheConfig;
    t.add(level + ".write_policy", section, &C::write_policy, {"back", "through"},
          "back: a written line stays until it makes room; through: every write goes on to the level below");
    t.add(level + ".write_miss", section, &C::write_miss, {"allocate", "around"},
          "allocate: a write that misses brings the line; around: it goes on to the level below instead");
    t.add(level + ".prefetcher", section, &C::prefetcher, {"none", "next", "stride"},
          "next: lines after one that missed or was prefetched; stride: by site of the program, at its "
          "accesses' distance");
    t.add(level + ".prefetch_degree", section, &C::prefetch_degree, "lines", 1, 1, 64,
          "that the prefetcher asks for at once");
    t.add(level + ".prefetch_sites", section, &C::prefetch_sites, "sites", 64, 1, 65536,
          "that the stride prefetcher tells apart");
    t.add(level + ".replacement", section, &C::replacement, {"lru", "plru", "srrip", "random"},
          "who makes room: the least recently used; what a tree of bits leads to; the farthest of two-bit "
          "predictions of the next use; any, by a fixed sequence");
}

/// What a level below the L1 is by default.
struct LevelPresets {
    std::vector<std::string> share;
    integer size_bytes, least_bytes, ways, latency, banks, mshrs, write_back_buffer;
};
void add_level(Table& t, const std::string& level, CacheConfig Config::*section, const LevelPresets& d) {
    using C = CacheConfig;
    t.add(level + ".size_bytes", section, &C::size_bytes, "bytes", d.size_bytes, d.least_bytes,
          kibi * kibi * kibi,
          d.least_bytes == 0 ? "cache below the level above; 0: no such level, and none below it"
                             : "cache below the L1s");
    t.add(level + ".share", section, &C::share, d.share,
          d.least_bytes == 0 ? "cores that share one: all of the chip, beyond the tiles (the last level "
                               "alone), those of a tile, each its own, or so many neighbours"
                             : "cores that share one: those of a tile, each its own, or so many neighbours",
          integer{1} << 20);
    t.add(level + ".inclusion", section, &C::inclusion, {"none", "inclusive", "exclusive"},
          "none: lines come and go without regard to the levels above; inclusive: what leaves also leaves "
          "those; exclusive: holds what left the level above, and what is read moves up");
    t.add(level + ".ways", section, &C::ways, "", d.ways, 1, 64, "associativity");
    t.add(level + ".line_bytes", section, &C::line_bytes, "bytes", 64, 16, 1024, "line", true);
    t.add(level + ".latency", section, &C::latency, "cycles", d.latency, 1, 1000,
          "from access to data, and to the request of a miss");
    t.add(level + ".banks", section, &C::banks, "", d.banks, 1, 256, "banks, interleaved by line", true);
    t.add(level + ".bank_bytes", section, &C::bank_bytes, "bytes/cycle", 32, 1, 1024,
          "what a bank moves; a line keeps it busy", true);
    t.add(level + ".mshrs", section, &C::mshrs, "lines", d.mshrs, 1, 4096, "misses outstanding");
    t.add(level + ".write_back_buffer", section, &C::write_back_buffer, "lines", d.write_back_buffer, 1, 4096,
          "evicted dirty lines on their way");
    add_policies(t, level, section);
}

void add_caches(Table& t) {
    using A = L1Config;
    auto a = &Config::l1;
    t.add("l1.size_bytes", a, &A::size_bytes, "bytes", 8 * kibi, 16, 64 * kibi * kibi,
          "data cache of a core");
    t.add("l1.ways", a, &A::ways, "", 4, 1, 64, "associativity");
    t.add("l1.line_bytes", a, &A::line_bytes, "bytes", 64, 16, 1024, "line", true);
    t.add("l1.latency", a, &A::latency, "cycles", 2, 1, 1000,
          "from access to data, and to the request of a miss");
    t.add("l1.ports", a, &A::ports, "accesses/cycle", 1, 1, 16, "accesses that start in a cycle");
    t.add("l1.port_bytes", a, &A::port_bytes, "bytes", 16, 4, 1024,
          "bytes of one access; wider ones take more", true);
    t.add("l1.mshrs", a, &A::mshrs, "lines", 8, 1, 1024, "misses outstanding");
    t.add("l1.write_back_buffer", a, &A::write_back_buffer, "lines", 4, 1, 1024,
          "evicted dirty lines on their way");
    add_policies(t, "l1", a);
    add_level(t, "l2", &Config::l2, {{"tile", "core"}, 128 * kibi, 64, 8, 12, 4, 16, 8});
    add_level(t, "l3", &Config::l3, {{"chip", "tile", "core"}, 0, 0, 16, 40, 8, 64, 32});
    add_level(t, "l4", &Config::l4, {{"chip", "tile", "core"}, 0, 0, 16, 60, 8, 128, 64});
    add_level(t, "l5", &Config::l5, {{"chip", "tile", "core"}, 0, 0, 16, 80, 8, 128, 64});
    using C = CoherenceConfig;
    auto c = &Config::coherence;
    t.add("coherence.plain", c, &C::plain, {"none", "directory", "snoop"},
          "of data that are not shared words; none: caches keep what others write; directory: lines are "
          "modified, exclusive, shared or invalid (MESI), in a tile as its caches know of each other, beyond "
          "the tiles by a directory at each line's bank or memory channel; snoop: beyond the tiles as their "
          "last caches see each other's requests on buses (network.topology)");
    t.add("coherence.directory_cycles", c, &C::directory_cycles, "cycles", 6, 1, 10000,
          "of a look-up of the directory, before anything else happens there");
    t.add(
        "coherence.directory_entries", c, &C::directory_entries, "", 0, 0, 1 << 30,
        "of the directory at each bank of the cache that all tiles share, or at each memory channel, a line "
        "each; a line that another's needs the room of is recalled from who has it; 0: room for all");
    t.add("coherence.directory_ways", c, &C::directory_ways, "", 8, 1, 1024,
          "entries of a set; the one asked for least recently leaves");
    t.add("coherence.snoop_cycles", c, &C::snoop_cycles, "cycles", 6, 1, 10000,
          "from a request on a bus until all caches there have said what they have of its line");
    t.add("coherence.visibility_cycles", c, &C::visibility_cycles, "cycles", 10, 0, 100000,
          "from a write of a shared word until others of its tile see it");
    t.add("coherence.atomic_cycles", c, &C::atomic_cycles, "cycles", 2, 0, 1000,
          "that a read-modify-write adds to its access of the L2, where it acts");
    t.add("coherence.remote_cycles", c, &C::remote_cycles, "cycles", 0, 0, 100000,
          "that the line of a word which several tiles reach takes from one to another, before a "
          "read-modify-write acts there; and that a write is seen later there than in its own tile");
}

void add_tlb(Table& t) {
    using C = TlbConfig;
    auto s = &Config::tlb;
    t.add("tlb.entries", s, &C::entries, "pages", 0, 0, 65536,
          "translations that a core keeps; 0: addresses need none, and there are no TLBs");
    t.add("tlb.ways", s, &C::ways, "", 0, 0, 65536,
          "associativity; 0: any entry takes any page; the least recently used makes room");
    t.add("tlb.page_bytes", s, &C::page_bytes, "bytes", 4 * kibi, 4 * kibi, 2 * kibi * kibi, "page", true);
    t.add("tlb.second_entries", s, &C::second_entries, "pages", 0, 0, kibi * kibi,
          "of the TLB behind those of the cores; 0: there is none");
    t.add("tlb.second_ways", s, &C::second_ways, "", 0, 0, 65536,
          "its associativity; 0: any entry takes any page");
    t.add("tlb.second_latency", s, &C::second_latency, "cycles", 7, 0, 1000,
          "from a miss of the first to what the second has, or to the walk");
    t.add("tlb.second_share", s, &C::second_share, {"core", "tile"},
          "cores that share one: each its own, those of a tile, or so many neighbours", integer{1} << 20);
    t.add("tlb.misses", s, &C::misses, {"stall", "overlap"},
          "stall: a miss holds up its thread's younger operations; overlap: what waits for its data alone");
    t.add("tlb.walk", s, &C::walk, {"tables", "fixed"},
          "tables: a walk reads an entry of each level of page tables that the walk cache lacks, through the "
          "L1; fixed: it takes walk_cycles");
    t.add("tlb.walk_cycles", s, &C::walk_cycles, "cycles", 30, 0, 100000, "of a walk (walk = fixed)");
    t.add("tlb.walk_cache", s, &C::walk_cache, "entries", 16, 0, 4096,
          "of tables above the last that a core keeps, any of any level, in no time (walk = tables)");
    t.add("tlb.walkers", s, &C::walkers, "walks", 1, 1, 64, "of a core at a time");
    t.add("tlb.address_bits", s, &C::address_bits, "bits", 48, 40, 57,
          "of an address that the tables translate, nine a level and those within a page (walk = tables)");
}

void add_network(Table& t) {
    using C = NetworkConfig;
    auto s = &Config::network;
    t.add(
        "network.topology", s, &C::topology, {"ideal", "crossbar", "ring", "mesh", "bus"},
        "between tiles and what lies beyond them; ideal: neither time nor limit; crossbar: from any port to "
        "any other in one hop; ring: both ways round, the shorter one; mesh: along the row, then the column; "
        "bus: one that all take in turn, or several that meet where memory is");
    t.add("network.link_bytes", s, &C::link_bytes, "bytes/cycle", 32, 1, 1024,
          "width of a link or port, one way");
    t.add("network.hop_cycles", s, &C::hop_cycles, "cycles", 3, 0, 1000,
          "a router and the link behind it; the crossbar");
    t.add(
        "network.columns", s, &C::columns, "", 0, 0, 1024,
        "nodes of a row of a mesh, a divisor of chip.tiles; 0: as near a square as there is, rows no longer "
        "than columns");
    t.add("network.buses", s, &C::buses, "", 1, 1, 1024,
          "buses that tiles are divided among in order, so many as divide chip.tiles (topology = bus)");
    t.add("network.request_bytes", s, &C::request_bytes, "bytes", 8, 1, 256,
          "of a request for a line, or a word about one to a cache beyond the tiles");
    t.add("network.reply_bytes", s, &C::reply_bytes, "bytes", 8, 0, 256,
          "that come back with a line besides it");
    t.add("network.write_bytes", s, &C::write_bytes, "bytes", 8, 0, 256,
          "that go with what is written besides it");
}

/// Energies of events of a part, and its power at rest; 0: not counted.
template <class Section>
void add_energies(
    Table& t, const std::string& table, Section Config::*section,
    std::initializer_list<std::tuple<const char*, double Section::*, double, const char*>> all) {
    for (const auto& [name, member, preset, meaning] : all) {
        const bool power = std::string_view(name).ends_with("_mw");
        t.add(fmt::format("{}.{}", table, name), section, member, power ? "mW" : "pJ", preset, 0, 1e9,
              meaning);
    }
}

void add_memory_energies(Table& t) {
    using C = MemoryConfig;
    const C& d = memory_presets().front();
    add_energies<C>(
        t, "memory", &Config::memory,
        {{"activate_pj", &C::activate_pj, d.activate_pj, "a row opened and closed, in all devices of a rank"},
         {"read_pj", &C::read_pj, d.read_pj, "a burst read, bus and termination included"},
         {"write_pj", &C::write_pj, d.write_pj, "a burst written, likewise"},
         {"refresh_pj", &C::refresh_pj, d.refresh_pj, "a refresh of a rank"},
         {"background_mw", &C::background_mw, d.background_mw, "a rank, whatever it does"}});
}

void add_memory(Table& t) {
    using C = MemoryConfig;
    auto s = &Config::memory;
    const C& d = memory_presets().front();
    std::vector<std::string> presets;
    for (const C& preset : memory_presets())
        presets.push_back(preset.preset);
    t.add("memory.preset", s, &C::preset, presets,
          "sets all other memory keys but controller and controller_cycles, before what its layer says of "
          "them");
    auto& preset = std::get<ChoiceKind>(t.rows.back().kind);
    preset.sets = apply_memory_preset;
    preset.sets_key = memory_preset_sets;
    t.add("memory.clock_ps", s, &C::clock_ps, "ps", d.clock_ps, 50, 1000000, "period of the command clock");
    t.add("memory.channels", s, &C::channels, "", d.channels, 1, 256,
          "independent channels (HBM: pseudo channels)", true);
    t.add("memory.ranks", s, &C::ranks, "", d.ranks, 1, 8, "ranks of a channel", true);
    t.add("memory.bank_groups", s, &C::bank_groups, "", d.bank_groups, 1, 8, "bank groups of a rank", true);
    t.add("memory.banks", s, &C::banks, "", d.banks, 1, 64, "banks of a bank group", true);
    t.add("memory.rows", s, &C::rows, "", d.rows, 1, 1 << 24, "rows of a bank", true);
    t.add("memory.row_bytes", s, &C::row_bytes, "bytes", d.row_bytes, 64, 64 * kibi,
          "row of a bank, of all devices of a rank", true);
    t.add("memory.bus_bytes", s, &C::bus_bytes, "bytes", d.bus_bytes, 1, 256, "width of a channel's data bus",
          true);
    t.add("memory.burst_length", s, &C::burst_length, "transfers", d.burst_length, 2, 64,
          "transfers of one access", true);
    t.add("memory.transfers_per_clock", s, &C::transfers_per_clock, "", d.transfers_per_clock, 1, 16,
          "data transfers of a pin in a clock: 2 of DDR, 4 or 8 where data have a faster clock", true);
    t.add("memory.command_buses", s, &C::command_buses, "", d.command_buses, 1, 2,
          "2: one for rows and one for columns; each takes one command a clock");
    struct Timing {
        const char* name;
        integer C::*member;
        integer least, most;
        const char* meaning;
    };
    for (const Timing& p : {
             Timing{"tRCD", &C::tRCD, 1, 1000, "activate to column command"},
             {"tRP", &C::tRP, 1, 1000, "precharge to activate"},
             {"tRAS", &C::tRAS, 1, 1000, "activate to precharge"},
             {"tRC", &C::tRC, 1, 2000, "activate to activate of one bank"},
             {"tCL", &C::tCL, 1, 1000, "read command to first data"},
             {"tCWL", &C::tCWL, 1, 1000, "write command to first data"},
             {"tCCD_S", &C::tCCD_S, 1, 64, "column command to column command, other bank group"},
             {"tCCD_L", &C::tCCD_L, 1, 64, "column command to column command, same bank group"},
             {"tRRD_S", &C::tRRD_S, 1, 64, "activate to activate, other bank group"},
             {"tRRD_L", &C::tRRD_L, 1, 64, "activate to activate, same bank group"},
             {"tFAW", &C::tFAW, 1, 1000, "first to fifth activate of a rank"},
             {"tRTP", &C::tRTP, 1, 1000, "read command to precharge"},
             {"tWR", &C::tWR, 0, 1000, "last written data to precharge"},
             {"tWTR_S", &C::tWTR_S, 0, 1000, "last written data to read command, other bank group"},
             {"tWTR_L", &C::tWTR_L, 0, 1000, "last written data to read command, same bank group"},
             {"tRTW", &C::tRTW, 0, 64, "the bus idle from read to written data"},
             {"tRTRS", &C::tRTRS, 0, 64, "the bus idle from one rank's data to another's"},
             {"tREFI", &C::tREFI, 0, 1000000, "between refreshes, which close all rows of a rank; 0: none"},
             {"tRFC", &C::tRFC, 1, 100000, "a refresh blocks a rank"},
             {"tRFCpb", &C::tRFCpb, 1, 100000, "a refresh of one bank blocks it"},
             {"tRREFD", &C::tRREFD, 1, 1000, "refresh of one bank to activate or refresh of another"},
         })
        t.add(fmt::format("memory.{}", p.name), s, p.member, "clocks", d.*p.member, p.least, p.most,
              p.meaning);
    t.add(
        "memory.refresh", s, &C::refresh, {"all-bank", "per-bank"},
        "of all banks of a rank at once or of one after the other (queued controller; else always all-bank)");
    t.add("memory.refresh_postponed", s, &C::refresh_postponed, "", d.refresh_postponed, 0, 8,
          "refreshes that a rank with requests may put off (queued controller, all-bank)");
    t.add(
        "memory.page_policy", s, &C::page_policy, {"open", "closed", "timeout"},
        "open: a row stays open until another is wanted; closed: it closes after each access; timeout: after "
        "page_timeout");
    t.add("memory.page_timeout", s, &C::page_timeout, "clocks", d.page_timeout, 1, 1000000,
          "from a row's last access until it is closed, with page_policy = timeout");
    t.add("memory.scheduler", s, &C::scheduler, {"fr-fcfs", "fcfs"},
          "the oldest of an open row before others, or in each bank the oldest (queued controller)");
    t.add("memory.age_cap", s, &C::age_cap, "clocks", d.age_cap, 0, 1000000,
          "no younger burst goes before one that has waited longer; 0: no end (queued controller)");
    t.add("memory.read_queue", s, &C::read_queue, "bursts", d.read_queue, 1, 4096,
          "read bursts that a channel's controller holds (queued controller)");
    t.add("memory.write_queue", s, &C::write_queue, "bursts", d.write_queue, 1, 4096,
          "written bursts that a channel's controller holds");
    t.add("memory.write_high", s, &C::write_high, "bursts", d.write_high, 1, 4096,
          "queued, at which a batch is sent");
    t.add("memory.write_low", s, &C::write_low, "bursts", d.write_low, 0, 4095,
          "queued, at which the batch ends");
    t.add("memory.controller", s, &C::controller, {"immediate", "queued"},
          "immediate: answers each request when it comes; queued: has queues, and decides in order of time");
    t.add("memory.controller_cycles", s, &C::controller_cycles, "core cycles", 10, 0, 100000,
          "from the last cache to the memory's command bus and back, together");
    t.add_text(
        "memory.mapping", s, &C::mapping, d.mapping,
        "fields of an address, most significant first, above the bytes of a burst; x.2: two bits of x");
    t.add("memory.bank_xor", s, &C::bank_xor, {"off", "on"},
          "on: the lowest bits of the row are added to bank group and bank, bit by bit");
    add_memory_energies(t);
}

void add_energy(Table& t) {
    using C = EnergyConfig;
    add_energies<C>(
        t, "energy", &Config::energy,
        {{"instruction_pj", &C::instruction_pj, 0, "fetching, decoding, scheduling one, its registers"},
         {"logic_pj", &C::logic_pj, 0,
          "a lane of integer, select, mask, compare, convert, shuffle, reduce ..."},
         {"add_pj", &C::add_pj, 0, "a lane of a floating-point addition"},
         {"multiply_pj", &C::multiply_pj, 0, "a lane of a multiplication, integer or not"},
         {"fused_pj", &C::fused_pj, 0, "a lane of a fused multiplication and addition"},
         {"divide_pj", &C::divide_pj, 0, "a lane of a division or square root"},
         {"l1_access_pj", &C::l1_access_pj, 0, "an access of l1.port_bytes"},
         {"l1_line_pj", &C::l1_line_pj, 0, "a line filled or written back"},
         {"l2_line_pj", &C::l2_line_pj, 0,
          "an access, fill or write-back, the way to the tile's cores included"},
         {"network_pj", &C::network_pj, 0, "a byte over a hop of the network"},
         {"directory_pj", &C::directory_pj, 0, "a look-up of a directory"},
         {"snoop_pj", &C::snoop_pj, 0, "a look-up of a cache's tags for what another one asks for"},
         {"core_mw", &C::core_mw, 0, "a core with its L1, whatever it does: leakage and clock"},
         {"tile_mw", &C::tile_mw, 0, "a tile's L2, likewise"}});
}

void add_kdtree(Table& t) {
    t.add(
        "kdtree.share", &Config::kdtree, &KdTreeConfig::share, {"chip", "tile", "core", "worker"},
        "workers that share a kd-tree and its grids: all, those of a tile or core, none, or so many that are "
        "neighbours on the chip",
        integer{1} << 20);
}

void add_renderer(Table& t) {
    t.add(
        "renderer.discard", &Config::renderer, &RendererConfig::discard, {"off", "on"},
        "on: item lists that are done with, and at the frame's end all that its workers have built, are said "
        "to be dead, an instruction a line, so that caches need not write them back");
}

void apply_mode(Config& config, const std::string& name) {
    const bool reference = name == "reference";
    config.memory.controller = reference ? "queued" : "immediate";
    if (reference)
        config.sim.quantum = config.sim.window = 0;
}

bool mode_sets(const Config& chosen, std::string_view key) {
    return key == "memory.controller" ||
           (chosen.sim.mode == "reference" && (key == "sim.quantum" || key == "sim.window"));
}

void add_simulation(Table& t) {
    using C = SimulationConfig;
    auto s = &Config::sim;
    t.add(
        "sim.mode", s, &C::mode, {"fast", "reference"},
        "fast sets memory.controller immediate; reference queued, sim.quantum and sim.window 0; before what "
        "its layer says of them");
    auto& mode = std::get<ChoiceKind>(t.rows.back().kind);
    mode.sets = apply_mode;
    mode.sets_key = mode_sets;
    t.add("sim.quantum", s, &C::quantum, "cycles", 1, 0, 100000,
          "threads of a tile run ahead of each other for so long at most; as long as a window or longer: "
          "each runs "
          "a whole window in turn; 0 or 1: ordered operation by operation");
    t.add(
        "sim.window", s, &C::window, "cycles", 0, 0, 100000,
        "tiles and memory meet at the ends of windows this long; 0: as long as changes nothing, the shortest "
        "way to memory and back");
    t.add("sim.miss_causes", s, &C::miss_causes, {"off", "on"},
          "on: misses are told apart by cause, with a fully associative cache beside each; takes host time");
    t.add(
        "sim.frame_end", s, &C::frame_end, {"drop", "write"},
        "what of dead data caches have not written back when the frame has ended: drop: the next frame would "
        "write over it first; write: something else would have it written back");
    t.add("sim.jitter", s, &C::jitter, "", 0, 0, (integer{1} << 31) - 1,
          "seed of noise: each line that an L1 asks for is asked for 0 or 1 cycle later, by this; 0: none");
    t.add("sim.stack_kib", s, &C::stack_kib, "KiB", 1024, 128, 65536, "host stack of a simulated thread");
}

} // namespace

std::vector<Parameter> make_parameter_table() {
    Table t;
    add_chip(t);
    add_core(t);
    add_lanes(t);
    add_classes(t);
    add_caches(t);
    add_tlb(t);
    add_network(t);
    add_memory(t);
    add_kdtree(t);
    add_renderer(t);
    add_energy(t);
    add_simulation(t);
    return std::move(t.rows);
}

} // namespace sim
