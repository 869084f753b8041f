// What one tile says of a machine: two runs of it, one with all its threads, one with a lone worker, as
// service demands and latencies for each instruction. The crowded run knows the caches as they are shared;
// the lone one what work takes where nobody is in the way.
#pragma once

#include "sim/machine/report.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// What a phase's work is: done once a frame, by all workers together; builds of what several may need; of
/// one screen tile alone; the end of the frame.
enum class PhaseUse : std::uint8_t { once, builds, renders, end };

struct SeedPhase {
    double instructions = 0;      // of the crowded run
    double alone = 0;             // cycles of a lone worker for one, waits for shared words not counted
    double reads = 0, writes = 0; // lines of memory, of the crowded run
    double lines = 0;  // different ones that no phase touched before it, but for those done once ...
    double before = 0; // ... and of these, those that one of the latter did
    PhaseUse use = PhaseUse::renders;
};

struct Seed {
    std::vector<SeedPhase> phases{}; // and the end of the frame, last
    // Of the crowded run, for one instruction: cycles ...
    double core = 0;                         // of what each core has one of: issue slots, a port, the L1's
    double unit = 0;                         // of a unit that cores share
    std::array<double, most_levels> banks{}; // of a bank of a cache; the L1: 0
    double network_bytes = 0;                // ... bytes ...
    double lines = 0, activates = 0;         // ... from and to memory, and rows that they open
    double word_wait = 0;                    // cycles that a worker waited for what others built
    double at_work = 1;                      // workers that had something to do
    double worker_reads = 0;                 // lines that each worker reads in phases done once, for itself
    // Of the lone run, cycles of waiting for one instruction, by where data came from: levels, then memory.
    std::array<double, most_levels + 1> waits{};
    /// How many more lines come from below each level where threads share the caches, as a ratio.
    std::array<double, most_levels> crowding{};
};

/// `uses`: of phases, but for the end of the frame (waits for others in those done once are not those of
/// builds). `at_work`: workers of the crowded run that had something to do.
Seed seed_of(const Report& crowded, const Report& lone, const std::vector<PhaseUse>& uses, int at_work);

/// With all numbers by name. Throws nlohmann::json::exception where they are not there.
nlohmann::ordered_json json_of_seed(const Seed& seed);
Seed seed_of_json(const nlohmann::ordered_json& json);

/// Whether one tile says the same of a machine in which this parameter is another.
bool known_to_seed(std::string_view key);
/// The first parameter in which the machine differs from the seed's and that changes what one tile would have
/// said (misses, instructions): its key; empty where there is none.
std::string unknown_to_seed(const Config& seed, const Config& machine);

} // namespace sim
