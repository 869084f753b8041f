#include "analysis/study/collected_point.h"

#include <fmt/format.h>

#include <algorithm>

namespace analysis {

std::vector<double> CollectedPoint::samples(const std::string& figure) const {
    if (!measured())
        return {};
    for (const Samples* const all : {&result->values, &result->host})
        if (const auto found = all->find(figure); found != all->end())
            return found->second;
    return {};
}

std::string CollectedPoint::word(const std::string& name) const {
    if (!measured() || !result->details.is_object())
        return "-";
    const auto found = result->details.find(name);
    return found != result->details.end() && found->is_string() ? found->get<std::string>() : "-";
}

std::string settings_text(const Point& point, const std::vector<std::string>& knobs,
                          const std::vector<std::string>& chosen) {
    std::string out = point.rival;
    for (const std::string& key : knobs)
        if (const auto found = point.settings.find(key);
            found != point.settings.end() && std::find(chosen.begin(), chosen.end(), key) != chosen.end())
            out += fmt::format("{}{} {}", out.empty() ? "" : ", ", key, plain_text(found->second));
    return out;
}

std::string settings_text(const Point& point, const std::vector<std::string>& knobs) {
    return settings_text(point, knobs, knobs);
}

} // namespace analysis
