// The one table of everything a machine file may set.
#pragma once

#include "sim/config/config.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace sim {

struct IntegerKind {
    std::function<integer&(Config&)> at;
    integer least, most;
    bool power_of_two = false;
    integer preset = 0;
};
struct RealKind {
    std::function<double&(Config&)> at;
    double least, most;
    double preset = 0;
};
struct ChoiceKind {
    std::function<std::string&(Config&)> at;
    std::vector<std::string> choices; // the first is the default
    integer most_number = 0;          // whole numbers from 1 to this will do as well
    /// What the choice sets besides itself; such a key goes before all others of its layer.
    std::function<void(Config&, const std::string&)> sets = nullptr;
    std::function<bool(const Config& chosen, std::string_view key)> sets_key = nullptr;
};
struct TextKind {
    std::function<std::string&(Config&)> at;
    std::string preset;
};

struct Parameter {
    std::string key;  // section.name
    std::string unit; // empty: a number without one
    std::string meaning;
    std::variant<IntegerKind, RealKind, ChoiceKind, TextKind> kind;
};

/// Whether setting the parameter sets others.
inline bool sets_others(const Parameter& p) {
    const auto* c = std::get_if<ChoiceKind>(&p.kind);
    return c != nullptr && c->sets != nullptr;
}

/// In the order in which they are printed.
std::span<const Parameter> parameters();
/// nullptr where no parameter has this key.
const Parameter* find_parameter(std::string_view key);
/// The known key most like this one.
const std::string& nearest_key(std::string_view key);

/// Whether the machine has what the parameter is of: not so for a level of caches that it lacks, but for the
/// size that says so.
bool applies(const Parameter& p, const Config& config);
/// Whether all parameters have the same values in both, but those that apply to neither.
bool alike(const Config& a, const Config& b);
/// The value of a parameter, as TOML writes it.
std::string print_value(const Parameter& p, const Config& config);
/// What it may be and in which unit: "1 to 64 bytes, a power of two".
std::string print_bounds(const Parameter& p);
/// Sets a parameter from a number or a word; returns what is wrong, or an empty string.
std::string set_integer(const Parameter& p, Config& config, integer value);
std::string set_real(const Parameter& p, Config& config, double value);
std::string set_text(const Parameter& p, Config& config, const std::string& value);

} // namespace sim
