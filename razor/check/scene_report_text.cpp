#include "razor/check/scene_report.h"

#include "razor/scene/text_file.h"
#include "razor/scene/words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace razor::check {
namespace {

const char* word_of_severity(Severity severity) {
    return severity == Severity::warning ? "warning" : "note";
}

double mebibytes(std::int64_t bytes) {
    return static_cast<double>(bytes) / (1 << 20);
}

const std::string& name_of(const Scene& scene, const PrecisionBudget& p) {
    return scene.meshes[static_cast<std::size_t>(p.mesh)].name;
}

} // namespace

std::string text_of(const std::vector<SceneFinding>& findings) {
    std::string text;
    for (const SceneFinding& f : findings)
        text += fmt::format("{}: {}: {}: {}; {}\n", word_of_severity(f.severity), f.object, f.what, f.means,
                            f.mend);
    return text;
}

std::string text_of(const Scene& scene, const std::vector<PrecisionBudget>& budgets) {
    if (budgets.empty())
        return "";
    const PrecisionBudget& worst =
        *std::min_element(budgets.begin(), budgets.end(),
                          [](const PrecisionBudget& a, const PrecisionBudget& b) { return a.bits < b.bits; });
    return fmt::format(
        "precision: at least {:.1f} bits for an edge (mesh '{}', edges of {:.2g}, hits within {:.2g} "
        "units{})\n",
        worst.bits, printable(name_of(scene, worst), 60), worst.edge_length, worst.error,
        worst.error_pixels > 0 ? fmt::format(", {:.1g} pixels", worst.error_pixels) : "");
}

std::string text_of(const MemoryEstimate& e) {
    return fmt::format(
        "memory: at most about {:.1f} MiB: {:.1f} of what outlives frames, {:.1f} of textures, {:.1f} of "
        "the film, about {:.1f} to {:.1f} built by a frame (from pictures of {} and {} pixels, which "
        "built {:.1f} and {:.1f})\n",
        mebibytes(e.total()), mebibytes(e.lasting), mebibytes(e.textures), mebibytes(e.film),
        mebibytes(e.built_least), mebibytes(e.built_most), e.from[0].first, e.from[1].first,
        mebibytes(e.from[0].second), mebibytes(e.from[1].second));
}

nlohmann::ordered_json json_of(const std::vector<SceneFinding>& findings) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const SceneFinding& f : findings)
        json.push_back({{"severity", word_of_severity(f.severity)},
                        {"kind", f.kind},
                        {"object", f.object},
                        {"what", f.what},
                        {"means", f.means},
                        {"mend", f.mend}});
    return json;
}

nlohmann::ordered_json json_of(const Scene& scene, const std::vector<PrecisionBudget>& budgets) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const PrecisionBudget& p : budgets)
        json.push_back({{"mesh", name_of(scene, p)},
                        {"instances", p.instances},
                        {"from_centre", p.from_centre},
                        {"edge_length", p.edge_length},
                        {"bits", p.bits},
                        {"error", p.error},
                        {"error_pixels", p.error_pixels}});
    return json;
}

nlohmann::ordered_json json_of(const MemoryEstimate& e) {
    nlohmann::ordered_json json{{"total_bytes", e.total()},           {"lasting_bytes", e.lasting},
                                {"texture_bytes", e.textures},        {"film_bytes", e.film},
                                {"built_bytes_least", e.built_least}, {"built_bytes_most", e.built_most}};
    json["estimated_from"] = nlohmann::ordered_json::array();
    for (const auto& [pixels, bytes] : e.from)
        json["estimated_from"].push_back({{"pixels", pixels}, {"built_bytes", bytes}});
    return json;
}

} // namespace razor::check
