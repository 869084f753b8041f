// The report for programs.
#include "sim/machine/derived.h"
#include "sim/machine/energy.h"
#include "sim/machine/json_parts.h"
#include "sim/machine/limits.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

json stack(const Report& r, const Stack& s) {
    json out = json::object();
    for (std::size_t i = 0; i < cause_count; ++i)
        if (has_cause(i, r.config.cache_levels(), r.config.tlb.any(), r.config.coherence.kept()))
            out[causes[i].name] = s[i];
    return out;
}

/// Of each core's threads together, with what its issue ports took.
json cores(const Report& r) {
    json out = json::array();
    std::vector<Stack> stacks = r.core_stacks();
    for (std::size_t core = 0; core < stacks.size(); ++core) {
        std::uint64_t instructions = 0;
        for (const ThreadReport& t : r.threads)
            if (static_cast<std::size_t>(t.core) == core)
                instructions += t.instructions;
        json row = {{"core", core}, {"instructions", instructions}, {"stack", stack(r, stacks[core])}};
        if (!r.port_instructions[core].empty())
            row["port_instructions"] = r.port_instructions[core];
        out.push_back(std::move(row));
    }
    return out;
}

/// Over the columns that are wanted.
template <class Wanted> Stack sum_of(const ThreadReport& t, Wanted wanted) {
    Stack sum{};
    for (std::size_t c = 0; c < t.stacks.size(); ++c)
        if (wanted(c))
            for (std::size_t i = 0; i < cause_count; ++i)
                sum[i] += t.stacks[c][i];
    return sum;
}
template <class Wanted> Work sum_of(const std::vector<Work>& work, Wanted wanted) {
    Work sum;
    for (std::size_t c = 0; c < work.size(); ++c)
        if (wanted(c)) {
            sum.vops += work[c].vops;
            sum.instructions += work[c].instructions;
        }
    return sum;
}

json threads(const Report& r) {
    json out = json::array();
    for (const ThreadReport& t : r.threads) {
        json row = {{"tile", t.tile},     {"core", t.core},     {"thread", t.thread},
                    {"worker", t.worker}, {"finish", t.finish}, {"instructions", t.instructions}};
        row["stack_of_all_phases"] = stack(r, t.stack());
        for (std::size_t p = 0; p < r.labels.phases.size(); ++p)
            row["stack"][r.labels.phases[p]] =
                stack(r, sum_of(t, [&](std::size_t c) { return r.labels.phase(c) == p; }));
        out.push_back(std::move(row));
    }
    return out;
}

json traffic(const Report& r) {
    json out = json::array();
    for (const TrafficRow& t : r.traffic) {
        json row = {{"structure", r.structures[t.structure]},
                    {"level", t.level ? json(*t.level) : json()},
                    {"kind", r.labels.kinds[r.labels.kind(t.column)]},
                    {"phase", r.labels.phases[r.labels.phase(t.column)]}};
        for (const TrafficColumn& column : traffic_columns)
            if (column.level < r.config.cache_levels())
                row[column.name] = t.traffic.*column.count;
        out.push_back(std::move(row));
    }
    return out;
}

/// How many lines of a structure were accessed by these kinds and phases and by no other.
json touched(const Report& r) {
    json out = json::array();
    for (const TouchedLines& t : r.touched) {
        json row = {{"structure", r.structures[t.structure]}, {"lines", t.lines}};
        for (std::size_t c = 0; c < r.labels.columns(); ++c)
            if ((t.columns >> c & 1U) != 0)
                row["by"][r.labels.kinds[r.labels.kind(c)]].push_back(r.labels.phases[r.labels.phase(c)]);
        out.push_back(std::move(row));
    }
    return out;
}

json phases(const Report& r) {
    json out = json::array();
    for (std::size_t p = 0; p < r.labels.phases.size(); ++p) {
        Work w = sum_of(r.work, [&](std::size_t c) { return r.labels.phase(c) == p; });
        out.push_back({{"phase", r.labels.phases[p]}, {"vops", w.vops}, {"instructions", w.instructions}});
    }
    return out;
}

json kinds(const Report& r) {
    json out = json::array();
    for (std::size_t k = 0; k < r.labels.kinds.size(); ++k) {
        auto wanted = [&](std::size_t c) { return r.labels.kind(c) == k; };
        Work w = sum_of(r.work, wanted);
        Stack all{};
        for (const ThreadReport& t : r.threads) {
            Stack s = sum_of(t, wanted);
            for (std::size_t i = 0; i < cause_count; ++i)
                all[i] += s[i];
        }
        out.push_back({{"kind", r.labels.kinds[k]},
                       {"vops", w.vops},
                       {"instructions", w.instructions},
                       {"stack", stack(r, all)}});
    }
    return out;
}

/// By class, as scalars and as vectors; memory instructions are classes of their own.
json instructions_by_class(const Report& r) {
    json out = json::object();
    for (std::size_t k = 0; k < form_kinds; ++k)
        out[std::string(bare_name(k))] = {{"scalar", r.by_kind[k]}, {"vector", r.by_kind[vector_kind(k)]}};
    return out;
}

json network(const Report& r) {
    json out = json_of_counters(r.network.counters, network_counters);
    const LinkUse& most = r.network.busiest();
    out["busiest_link"] = most.link;
    out["busiest_utilisation"] = ratio(most.flits, r.drained);
    out["mean_utilisation"] = ratio(r.network.counters.link_flits, r.network.links.size() * r.drained);
    for (const LinkUse& l : r.network.links)
        out["links"].push_back({{"link", l.link}, {"flits", l.flits}});
    return out;
}

json energy(const Report& r) {
    const std::vector<EnergyPart> parts = energy_parts(r);
    const EnergyTotal all = total(r, parts);
    json out = {{"joules", all.joules}, {"watts", all.watts()}, {"joule_seconds", all.joule_seconds()}};
    for (const EnergyPart& p : parts)
        out["parts"].push_back({{"part", p.part}, {"events", p.events}, {"joules", p.joules}});
    return out;
}

} // namespace

std::string print_json(const Report& r, bool with_host) {
    json out;
    out["machine"] = json_of_configuration(r.config);
    out["mode"] = r.config.sim.mode;
    out["workers"] = r.workers;
    out["warm_up_cycles"] = r.warm_up;
    out["cycles"] = r.cycles;
    out["drained_cycles"] = r.drained;
    out["window_cycles"] = r.window;
    out["seconds"] = r.seconds();
    out["jitter"] = {{"seed", r.config.sim.jitter}, {"lines", r.jitter.lines}, {"cycles", r.jitter.cycles}};
    if (r.interval != 0)
        out["intervals"] = {{"cycles", r.interval}, {"rows", r.intervals.size()}};
    out["coherence_of_plain_data"] = r.config.coherence.kept() ? r.config.coherence.plain : "not modelled";
    out["core"] = json_of_counters(r.core, core_counters);
    out["instructions_by_class"] = instructions_by_class(r);
    out["stack"] = stack(r, r.stack());
    out["cores"] = cores(r);
    if (!r.shared_unit_cycles.empty())
        out["shared_unit_cycles"] = r.shared_unit_cycles;
    out["phases"] = phases(r);
    out["kinds"] = kinds(r);
    out["l1"] = json_of_counters(r.l1_total(), cache_counters);
    for (const CacheCounters& c : r.l1)
        out["l1_by_core"].push_back(json_of_counters(c, cache_counters));
    for (unsigned level = 1; level < r.config.cache_levels(); ++level) {
        const std::string name = fmt::format("l{}", level + 1);
        out[name] = json_of_counters(r.cache_total(level), cache_counters);
        const char* by = level == 1 && r.config.cores_sharing(1) == r.config.chip.cores ? "tile" : "cache";
        for (const CacheCounters& c : r.caches(level))
            out[fmt::format("{}_by_{}", name, by)].push_back(json_of_counters(c, cache_counters));
    }
    if (!r.tlb.empty())
        out["tlb"] = json_of_counters(r.tlb_total(), tlb_counters);
    for (const TlbCounters& c : r.tlb)
        out["tlb_by_core"].push_back(json_of_counters(c, tlb_counters));
    if (r.config.coherence.kept())
        out["coherence"] = json_of_counters(r.coherence, coherence_counters);
    if (!r.network.ideal())
        out["network"] = network(r);
    out["memory"] = json_of_counters(r.memory, memory_counters);
    out["memory"]["last_clock"] = r.memory.last_clock;
    for (const MemoryCounters& c : r.memory_by_rank)
        out["memory_by_rank"].push_back(json_of_counters(c, memory_counters));
    for (const Bandwidth& b : bandwidths(r))
        out["bandwidth"][b.level] = {
            {"achieved_gb_s", b.achieved}, {"peak_gb_s", b.peak}, {"utilisation", b.utilisation()}};
    const std::vector<Limit> all = limits(r);
    for (const Limit& l : all)
        out["limits"].push_back(
            {{"resource", l.resource}, {"cycles", l.cycles}, {"share", ratio(l.cycles, r.drained)}});
    out["binding"] = binding(all).resource;
    out["limiter"] = limiter(r);
    out["energy"] = energy(r);
    out["traffic"] = traffic(r);
    out["touched_lines"] = touched(r);
    for (const OwnerSum& s : r.owners)
        out["owners"][s.name] = {{"owners", s.owners}, {"builds", s.builds}, {"nobody", s.nobody}};
    out["threads"] = threads(r);
    if (with_host)
        out["host"] = {
            {"seconds", r.host_seconds},
            {"processor_seconds", r.processor_seconds},
            {"threads", r.host_threads},
            {"vops_per_second", static_cast<double>(r.all_vops) / r.processor_seconds},
            {"instructions_per_second", static_cast<double>(r.all_instructions) / r.processor_seconds}};
    return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace sim
