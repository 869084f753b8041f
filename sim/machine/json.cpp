// The report for programs.
#include "sim/config/parameters.h"
#include "sim/machine/derived.h"
#include "sim/machine/limits.h"

#include <nlohmann/json.hpp>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

template <class Counters, class Rows> json counters(const Counters& c, const Rows& rows) {
    json out = json::object();
    for (const auto& row : rows)
        out[row.name] = c.*row.count;
    return out;
}

json configuration(const Config& config) {
    json out = json::object();
    for (const Parameter& p : parameters()) {
        std::size_t dot = p.key.find('.');
        out[p.key.substr(0, dot)][p.key.substr(dot + 1)] = json::parse(print_value(p, config));
    }
    return out;
}

json stack(const Stack& s) {
    json out = json::object();
    for (std::size_t i = 0; i < cause_count; ++i)
        out[causes[i].name] = s[i];
    return out;
}

json threads(const Report& r) {
    json out = json::array();
    for (const ThreadReport& t : r.threads) {
        json row = {{"tile", t.tile},     {"core", t.core},     {"thread", t.thread},
                    {"worker", t.worker}, {"finish", t.finish}, {"instructions", t.instructions}};
        for (std::size_t p = 0; p < r.phases.size(); ++p)
            row["stack"][r.phases[p]] = stack(t.stacks[p]);
        out.push_back(std::move(row));
    }
    return out;
}

json traffic(const Report& r) {
    json out = json::array();
    for (std::size_t s = 0; s < r.structures.size(); ++s)
        for (std::size_t p = 0; p < r.phases.size(); ++p) {
            json row = {{"structure", r.structures[s]}, {"phase", r.phases[p]}};
            row.update(counters(r.traffic[s * r.phases.size() + p], traffic_columns));
            out.push_back(std::move(row));
        }
    return out;
}

json phases(const Report& r) {
    json out = json::array();
    for (std::size_t p = 0; p < r.phases.size(); ++p)
        out.push_back(
            {{"phase", r.phases[p]}, {"vops", r.phase_vops[p]}, {"instructions", r.phase_instructions[p]}});
    return out;
}

} // namespace

std::string print_json(const Report& r, bool with_host) {
    json out;
    out["machine"] = configuration(r.config);
    out["workers"] = r.workers;
    out["cycles"] = r.cycles;
    out["drained_cycles"] = r.drained;
    out["window_cycles"] = r.window;
    out["seconds"] = r.seconds();
    out["coherence_of_plain_data"] = "not modelled";
    out["core"] = counters(r.core, core_counters);
    out["stack"] = stack(r.stack());
    out["phases"] = phases(r);
    out["l1"] = counters(r.l1_total(), cache_counters);
    for (const CacheCounters& c : r.l1)
        out["l1_by_core"].push_back(counters(c, cache_counters));
    out["l2"] = counters(r.l2_total(), cache_counters);
    for (const CacheCounters& c : r.l2)
        out["l2_by_tile"].push_back(counters(c, cache_counters));
    out["memory"] = counters(r.memory, memory_counters);
    out["memory"]["last_clock"] = r.memory.last_clock;
    for (const MemoryCounters& c : r.memory_by_rank)
        out["memory_by_rank"].push_back(counters(c, memory_counters));
    for (const Bandwidth& b : bandwidths(r))
        out["bandwidth"][b.level] = {
            {"achieved_gb_s", b.achieved}, {"peak_gb_s", b.peak}, {"utilisation", b.utilisation()}};
    const std::vector<Limit> all = limits(r);
    for (const Limit& l : all)
        out["limits"].push_back(
            {{"resource", l.resource}, {"cycles", l.cycles}, {"share", ratio(l.cycles, r.drained)}});
    out["binding"] = binding(all).resource;
    out["limiter"] = limiter(r);
    out["traffic"] = traffic(r);
    out["threads"] = threads(r);
    if (with_host)
        out["host"] = {
            {"seconds", r.host_seconds},
            {"processor_seconds", r.processor_seconds},
            {"vops_per_second", static_cast<double>(r.core.vops) / r.processor_seconds},
            {"instructions_per_second", static_cast<double>(r.core.instructions) / r.processor_seconds}};
    return out.dump(2) + "\n";
}

} // namespace sim
