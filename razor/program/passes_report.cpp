#include "razor/program/passes_report.h"

#include "razor/scene/animation/pose.h"
#include "razor/scene/mesh_error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace razor {

std::string passes_text(const PassFigures& p) {
    std::string text = fmt::format("{:.6g} samples a pixel", p.mean_samples);
    if (p.threshold > 0 || p.target > 0)
        text += fmt::format(", at most {},", p.samples);
    text += fmt::format(" in {} passes, {:.2f} s", p.passes, p.seconds);
    if (p.threshold > 0)
        text += fmt::format("; {:.1f} % of pixels within noise {:g}", 100 * p.within_threshold, p.threshold);
    if (p.target > 0 && p.passes > 1)
        text += fmt::format("; estimated relative error {:.4g} +- {:.2g}, {} the {:g} asked for",
                            p.target_error, p.target_error_uncertainty,
                            p.target_error <= p.target ? "within" : "above", p.target);
    else if (p.target > 0)
        text += "; no estimate of the error from one pass";
    if (p.passes > 1)
        text += fmt::format("; estimated error of luminance {:.2g}, {:.2g} % of its mean", p.error,
                            100 * p.relative_error);
    return text;
}

std::string text_of(const EdgeChoice& c) {
    const LevelDifference& d = c.chosen;
    return fmt::format(
        "levels of detail: edges of {:g} pixels ({}); ones half as long differ by {:.2g} (square "
        "{:.2g} +- {:.1g}), of {} samples of {} pixels; {} frames in part, {:.2f} s",
        d.edge_pixels, c.reason, d.error, d.square, d.square_uncertainty, d.samples, d.pixels, c.frames,
        c.seconds);
}

nlohmann::ordered_json json_of(const EdgeChoice& c) {
    return {{"edge_pixels", c.chosen.edge_pixels},
            {"reason", c.reason},
            {"difference_to_half", c.chosen.error},
            {"square_of_difference", c.chosen.square},
            {"square_uncertainty", c.chosen.square_uncertainty},
            {"samples", c.chosen.samples},
            {"pixels", c.chosen.pixels},
            {"frames_in_part", c.frames},
            {"seconds", c.seconds}};
}

std::optional<EdgeChoice> choose_edges(SceneDescription& description, int frame, RenderOptions& options,
                                       bool given) {
    EdgeChoice choice;
    try {
        choice = naming_files(description, [&] {
            return choose_edge(build_scene(pose_of_frame(description, frame)), options,
                               options.passes.target_error, given);
        });
    } catch (const Cancelled&) {
        return std::nullopt;
    }
    description.settings.edge_pixels = choice.chosen.edge_pixels;
    if (options.passes.seconds > 0) { // one pass there is in any case
        options.passes.seconds = std::max(options.passes.seconds - choice.seconds, 1e-3);
    }
    return choice;
}

} // namespace razor
