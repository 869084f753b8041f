#include "sim/reports/flat.h"

#include <fmt/format.h>

#include <array>
#include <optional>

namespace sim {
namespace {

using nlohmann::json;

std::string joined(std::string_view prefix, std::string_view name) {
    return prefix.empty() ? std::string(name) : fmt::format("{}.{}", prefix, name);
}

/// What tells elements of reports' arrays apart, if they have such names.
std::optional<std::string> name_of(const json& element) {
    constexpr std::array keys{"structure", "level",    "kind", "phase", "part",
                              "resource",  "material", "tile", "core",  "thread"};
    std::string name;
    for (const char* key : keys) {
        const auto found = element.find(key);
        if (found == element.end() || found->is_structured() || found->is_null())
            continue;
        name = joined(name, found->is_string() ? found->get<std::string>() : found->dump());
    }
    return name.empty() ? std::nullopt : std::optional(name);
}

/// Calls visit(name, leaf) for all that is not structured.
template <class Visit> void walk(const json& value, std::string_view prefix, const Visit& visit) {
    if (value.is_object()) {
        for (const auto& item : value.items())
            walk(item.value(), joined(prefix, item.key()), visit);
    } else if (value.is_array()) {
        for (std::size_t k = 0; k < value.size(); ++k) {
            const std::optional<std::string> name = value[k].is_object() ? name_of(value[k]) : std::nullopt;
            walk(value[k], joined(prefix, name.value_or(std::to_string(k))), visit);
        }
    } else {
        visit(std::string(prefix), value);
    }
}

} // namespace

std::map<std::string, double> flat_numbers(const json& value, std::string_view prefix) {
    std::map<std::string, double> all;
    walk(value, prefix, [&](const std::string& name, const json& leaf) {
        if (leaf.is_number())
            all[name] += leaf.get<double>(); // of parts that have one name
    });
    return all;
}

std::map<std::string, std::string> flat_words(const json& value, std::string_view prefix) {
    std::map<std::string, std::string> all;
    walk(value, prefix, [&](const std::string& name, const json& leaf) {
        all[name] = leaf.is_string() ? leaf.get<std::string>() : leaf.dump();
    });
    return all;
}

} // namespace sim
