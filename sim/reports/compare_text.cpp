// What a comparison says, for people and for programs.
#include "sim/reports/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

std::string number(double x) {
    if (x == std::floor(x) && std::abs(x) < 1e15)
        return fmt::format("{:.0f}", x);
    return fmt::format("{:.5g}", x);
}

std::string ranged(const FigureRange& r) {
    if (!r.known)
        return "-";
    if (r.least == r.most)
        return number(r.median);
    return fmt::format("{} [{} .. {}]", number(r.median), number(r.least), number(r.most));
}

std::string verdict(const FigureChange& f, bool several, double noise) {
    if (!f.known())
        return "of one alone";
    if (f.first.median == f.second.median)
        return "same";
    if (several && !f.beyond_spread())
        return "within the runs' spread";
    if (std::isfinite(f.ratio()) && std::abs(f.ratio() - 1) * 100 < noise)
        return "within noise";
    return "";
}

std::string table(const std::vector<FigureChange>& figures, bool several, double noise) {
    std::vector<std::array<std::string, 5>> rows{{"figure", "first", "second", "second/first", ""}};
    for (const FigureChange& f : figures) {
        const double ratio = f.ratio();
        rows.push_back({f.name, ranged(f.first), ranged(f.second),
                        std::isfinite(ratio) ? fmt::format("{:.4f}", ratio) : "-",
                        verdict(f, several, noise)});
    }
    std::array<std::size_t, 4> width{};
    for (const auto& row : rows)
        for (std::size_t k = 0; k < 4; ++k)
            width[k] = std::max(width[k], row[k].size());
    std::string text;
    for (const auto& row : rows) {
        std::string line = fmt::format("  {:<{}}  {:>{}}  {:>{}}  {:>{}}  {}", row[0], width[0], row[1],
                                       width[1], row[2], width[2], row[3], width[3], row[4]);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string or_nothing(const std::string& value) {
    return value.empty() ? "-" : value;
}

json json_of(const std::vector<FigureChange>& figures) {
    json all = json::array();
    const auto range = [](const FigureRange& r) {
        return !r.known ? json() : json{{"median", r.median}, {"least", r.least}, {"most", r.most}};
    };
    for (const FigureChange& f : figures)
        all.push_back({{"figure", f.name},
                       {"first", range(f.first)},
                       {"second", range(f.second)},
                       {"ratio", std::isfinite(f.ratio()) ? json(f.ratio()) : json()},
                       {"beyond_spread", f.beyond_spread()}});
    return all;
}

json json_of(const std::vector<SettingChange>& settings) {
    json all = json::array();
    for (const SettingChange& s : settings)
        all.push_back({{"name", s.name}, {"first", s.first}, {"second", s.second}});
    return all;
}

} // namespace

std::string comparison_text(const ReportComparison& c, double noise, bool everything) {
    std::string text;
    if (c.settings.empty())
        text += "the same machine and run\n";
    else
        text += "what differs in machine and run (first, second):\n";
    for (const SettingChange& s : c.settings)
        text += fmt::format("  {}: {}, {}\n", s.name, or_nothing(s.first), or_nothing(s.second));
    constexpr std::size_t most_lines = 12;
    if (!c.scene.empty())
        text += "what differs in the scene (first, second):\n";
    for (std::size_t k = 0; k < std::min(c.scene.size(), most_lines); ++k)
        text += fmt::format("  line{}: {} | {}\n", c.scene[k].name, or_nothing(c.scene[k].first),
                            or_nothing(c.scene[k].second));
    if (c.scene.size() > most_lines)
        text += fmt::format("  and {} more lines\n", c.scene.size() - most_lines);
    text += "figures:\n" + table(c.figures, c.several, noise);
    if (!c.memory_bytes.empty())
        text += "bytes to and from memory:\n" + table(c.memory_bytes, c.several, noise);
    if (!everything)
        return text;
    std::vector<FigureChange> shown;
    for (const FigureChange& f : c.all)
        if (verdict(f, c.several, noise).empty())
            shown.push_back(f);
    return text + "all others that differ:\n" + table(shown, c.several, noise);
}

std::string comparison_json(const ReportComparison& c) {
    const json out{{"settings", json_of(c.settings)},
                   {"scene", json_of(c.scene)},
                   {"figures", json_of(c.figures)},
                   {"memory_bytes", json_of(c.memory_bytes)},
                   {"others", json_of(c.all)}};
    return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace sim
