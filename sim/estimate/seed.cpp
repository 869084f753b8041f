#include "sim/estimate/seed.h"

#include "sim/config/parameters.h"
#include "sim/machine/derived.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string_view>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

double over(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

std::uint64_t work_cycles(const Stack& s) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < cause_count; ++i)
        if (i != static_cast<std::size_t>(Cause::synchronise) && i != static_cast<std::size_t>(Cause::idle))
            sum += s[i];
    return sum;
}

double instructions_of(const Report& r, std::size_t phase) {
    double sum = 0;
    for (std::size_t c = 0; c < r.work.size(); ++c)
        if (r.labels.phase(c) == phase)
            sum += real(r.work[c].instructions);
    return sum;
}

Stack stack_of(const Report& r, std::size_t phase) {
    Stack sum{};
    for (const ThreadReport& t : r.threads)
        for (std::size_t c = 0; c < t.stacks.size(); ++c)
            if (r.labels.phase(c) == phase)
                for (std::size_t i = 0; i < cause_count; ++i)
                    sum[i] += t.stacks[c][i];
    return sum;
}

/// Cycles of what each core has one of, the busiest kind of it: of all cores together.
double core_cycles(const Report& r) {
    double ports = 0, l1 = 0;
    for (const auto& core : r.port_instructions)
        if (!core.empty())
            ports += real(*std::max_element(core.begin(), core.end()));
    for (const CacheCounters& c : r.l1)
        l1 += real(c.busy_cycles) / real(r.config.l1.ports);
    return std::max({real(r.core.instructions) / real(r.config.core.issue_width), ports, l1});
}

/// Lines of memory that a phase of this use reads.
double reads_of(const Report& r, const std::vector<PhaseUse>& uses, PhaseUse use) {
    double sum = 0;
    for (const TrafficRow& row : r.traffic)
        if (const std::size_t p = r.labels.phase(row.column); p < uses.size() && uses[p] == use)
            sum += real(row.traffic.memory_reads);
    return sum;
}

/// Lines belong to the first phase that touched them; whatever is done once comes before those.
void count_lines(const Report& r, std::vector<SeedPhase>& phases) {
    for (const TouchedLines& t : r.touched_last) {
        std::size_t first = phases.size();
        bool once = false;
        for (std::size_t c = 0; c < r.labels.columns(); ++c) {
            if ((t.columns >> c & 1U) == 0)
                continue;
            const std::size_t p = r.labels.phase(c);
            if (phases[p].use == PhaseUse::once)
                once = true;
            else
                first = std::min(first, p);
        }
        if (first == phases.size())
            continue;
        phases[first].lines += real(t.lines);
        phases[first].before += once ? real(t.lines) : 0;
    }
}

/// Lines that come from below a level, for one instruction.
double fills(const Report& r, unsigned level) {
    return over(real(r.cache_total(level).misses), real(r.core.instructions));
}

constexpr std::array<const char*, 4> use_names = {"once", "builds", "renders", "end"};
/// Throws json::exception where there is none of this name.
PhaseUse use_of(const std::string& name) {
    json numbers = json::object();
    for (std::size_t use = 0; use < use_names.size(); ++use)
        numbers[use_names[use]] = use;
    return static_cast<PhaseUse>(numbers.at(name).get<int>());
}

/// Every number of a seed beside its phases: visit(name, number).
template <class AnySeed, class Visit> void each_number(AnySeed& s, Visit visit) {
    visit("core_cycles", s.core);
    visit("unit_cycles", s.unit);
    visit("network_bytes", s.network_bytes);
    visit("memory_lines", s.lines);
    visit("row_activates", s.activates);
    visit("word_wait_cycles", s.word_wait);
    visit("workers_at_work", s.at_work);
    visit("memory_reads_of_a_worker", s.worker_reads);
    static constexpr std::array<const char*, most_levels> banks = {
        "l1_bank_cycles", "l2_bank_cycles", "l3_bank_cycles", "l4_bank_cycles", "l5_bank_cycles"};
    static constexpr std::array<const char*, most_levels> crowding = {
        "l1_crowding", "l2_crowding", "l3_crowding", "l4_crowding", "l5_crowding"};
    static constexpr std::array<const char*, most_levels + 1> waits = {
        "l1_wait_cycles", "l2_wait_cycles", "l3_wait_cycles",
        "l4_wait_cycles", "l5_wait_cycles", "memory_wait_cycles"};
    for (std::size_t i = 0; i < most_levels; ++i) {
        visit(banks[i], s.banks[i]);
        visit(crowding[i], s.crowding[i]);
    }
    for (std::size_t i = 0; i < waits.size(); ++i)
        visit(waits[i], s.waits[i]);
}

} // namespace

Seed seed_of(const Report& crowded, const Report& lone, const std::vector<PhaseUse>& uses, int at_work) {
    Seed s;
    const double all = real(crowded.core.instructions);
    s.phases.resize(crowded.labels.phases.size());
    double lone_instructions = 0, waited = 0;
    for (std::size_t p = 0; p < s.phases.size(); ++p) {
        SeedPhase& phase = s.phases[p];
        phase.use = p < uses.size() ? uses[p] : PhaseUse::end;
        phase.instructions = instructions_of(crowded, p);
        const bool known = p < lone.labels.phases.size();
        const double there = known ? instructions_of(lone, p) : 0;
        lone_instructions += there;
        if (there > 0)
            phase.alone = real(work_cycles(stack_of(lone, p))) / there;
        if (phase.use != PhaseUse::once)
            waited += real(stack_of(crowded, p)[static_cast<std::size_t>(Cause::synchronise)]);
    }
    // Phases that the lone run did not come to are as the others.
    double lone_cycles = 0;
    for (const ThreadReport& t : lone.threads)
        lone_cycles += real(work_cycles(t.stack()));
    for (SeedPhase& phase : s.phases)
        if (phase.alone == 0)
            phase.alone = over(lone_cycles, lone_instructions);
    for (const TrafficRow& row : crowded.traffic) {
        SeedPhase& phase = s.phases[crowded.labels.phase(row.column)];
        phase.reads += real(row.traffic.memory_reads);
        phase.writes += real(row.traffic.memory_writes);
    }
    count_lines(crowded, s.phases);
    s.at_work = at_work;
    if (crowded.workers > lone.workers)
        s.worker_reads =
            std::max(reads_of(crowded, uses, PhaseUse::once) - reads_of(lone, uses, PhaseUse::once), 0.0) /
            (crowded.workers - lone.workers);
    s.core = over(core_cycles(crowded), all);
    for (const std::uint64_t cycles : crowded.shared_unit_cycles)
        s.unit += over(real(cycles), all);
    for (unsigned level = 1; level < crowded.config.cache_levels(); ++level)
        s.banks[level] = over(real(crowded.cache_total(level).busy_cycles), all);
    s.network_bytes = over(real(crowded.network.counters.bytes), all);
    s.lines = over(real(crowded.memory.reads + crowded.memory.writes), all);
    s.activates = over(real(crowded.memory.activates), all);
    s.word_wait = over(waited, at_work);
    Stack stack{};
    for (const ThreadReport& t : lone.threads) {
        const Stack own = t.stack();
        for (std::size_t i = 0; i < cause_count; ++i)
            stack[i] += own[i];
    }
    for (std::size_t i = 0; i < s.waits.size(); ++i)
        s.waits[i] = over(real(stack[static_cast<std::size_t>(Cause::l1) + i]), lone_instructions);
    for (unsigned level = 0; level < most_levels; ++level) {
        const bool there = level < crowded.config.cache_levels() && fills(lone, level) > 0;
        s.crowding[level] = there ? fills(crowded, level) / fills(lone, level) : 1;
    }
    return s;
}

json json_of_seed(const Seed& seed) {
    json out = json::object();
    each_number(seed, [&](const char* name, double value) { out[name] = value; });
    out["phases"] = json::array();
    for (const SeedPhase& p : seed.phases)
        out["phases"].push_back({{"instructions", p.instructions},
                                 {"alone_cycles", p.alone},
                                 {"memory_reads", p.reads},
                                 {"memory_writes", p.writes},
                                 {"lines", p.lines},
                                 {"lines_touched_before", p.before},
                                 {"use", use_names[static_cast<std::size_t>(p.use)]}});
    return out;
}

Seed seed_of_json(const json& from) {
    Seed s;
    each_number(s, [&](const char* name, double& value) { value = from.at(name).get<double>(); });
    for (const json& p : from.at("phases"))
        s.phases.push_back({p.at("instructions").get<double>(), p.at("alone_cycles").get<double>(),
                            p.at("memory_reads").get<double>(), p.at("memory_writes").get<double>(),
                            p.at("lines").get<double>(), p.at("lines_touched_before").get<double>(),
                            use_of(p.at("use").get<std::string>())});
    return s;
}

bool known_to_seed(std::string_view key) {
    // What changes only how many there are of what, and how long each takes. Timings of memory, its clock and
    // its channels, are all of [memory]'s.
    constexpr std::string_view known[] = {"chip.tiles",
                                          "chip.threads",
                                          "chip.clock_ps",
                                          "chip.placement",
                                          "network.hop_cycles",
                                          "network.link_bytes",
                                          "network.topology",
                                          "network.columns",
                                          "sim.mode",
                                          "sim.quantum",
                                          "sim.window",
                                          "sim.jitter",
                                          "sim.miss_causes",
                                          "sim.stack_kib",
                                          "l2.latency",
                                          "l3.latency",
                                          "l4.latency",
                                          "l5.latency",
                                          "coherence.remote_cycles"};
    return key.starts_with("memory.") || key.starts_with("energy.") ||
           std::find(std::begin(known), std::end(known), key) != std::end(known);
}

std::string unknown_to_seed(const Config& seed, const Config& machine) {
    if (seed.network.ideal() && !machine.network.ideal()) // it counted no bytes of messages
        return "network.topology";
    for (const Parameter& p : parameters()) {
        const bool other = applies(p, seed) != applies(p, machine);
        if (known_to_seed(p.key) || (other && p.key.starts_with("network."))) // an ideal one, or of buses
            continue;
        if (other || print_value(p, seed) != print_value(p, machine))
            return p.key;
    }
    return "";
}

} // namespace sim
