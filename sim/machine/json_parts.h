// What reports for programs are made of, of runs and of replays.
#pragma once

#include "sim/config/parameters.h"

#include <nlohmann/json.hpp>

namespace sim {

/// `rows`: names of counters and where they lie.
template <class Counters, class Rows>
nlohmann::ordered_json json_of_counters(const Counters& c, const Rows& rows) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const auto& row : rows)
        out[row.name] = c.*row.count;
    return out;
}

/// All parameters that apply, by section.
inline nlohmann::ordered_json json_of_configuration(const Config& config) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const Parameter& p : parameters())
        if (applies(p, config)) {
            const std::size_t dot = p.key.find('.');
            out[p.key.substr(0, dot)][p.key.substr(dot + 1)] =
                nlohmann::ordered_json::parse(print_value(p, config));
        }
    return out;
}

} // namespace sim
