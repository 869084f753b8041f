#include "sim/program/provenance.h"

#include "sim/config/parameters.h"

#include <fmt/core.h>

namespace sim {

nlohmann::ordered_json provenance_json(const MachineDescription& machine) {
    nlohmann::ordered_json out;
    for (std::size_t i = 0; i < machine.origins.size(); ++i) {
        const Origin& origin = machine.origins[i];
        const Mark mark = read_mark(origin.comment);
        nlohmann::ordered_json row{{"from", origin.place()}};
        if (mark.kind == Mark::known)
            row.update({{"mark", "known"}, {"source", mark.source}});
        else if (mark.kind == Mark::assumed)
            row["mark"] = "assumed";
        if (!mark.remark.empty())
            row["remark"] = mark.remark;
        out[parameters()[i].key] = std::move(row);
    }
    return out;
}

std::string provenance_text(const MachineDescription& machine) {
    int known = 0, assumed = 0, unmarked = 0, settings = 0, others_set = 0, defaults = 0;
    for (const Origin& origin : machine.origins) {
        const Mark::Kind kind = read_mark(origin.comment).kind;
        int& count = origin.layer == Origin::preset    ? defaults
                     : origin.layer == Origin::setting ? (origin.by_another ? others_set : settings)
                     : kind == Mark::known             ? known
                     : kind == Mark::assumed           ? assumed
                                                       : unmarked;
        ++count;
    }
    std::string out = fmt::format("machine                {}: {} parameters known, {} assumed", machine.name,
                                  known, assumed);
    const std::pair<int, const char*> others[] = {{unmarked, "unmarked"},
                                                  {settings, "overridden"},
                                                  {others_set, "set by what is overridden"},
                                                  {defaults, "left to defaults"}};
    for (const auto& [count, what] : others)
        if (count > 0)
            out += fmt::format(", {} {}", count, what);
    return out + "\n";
}

} // namespace sim
