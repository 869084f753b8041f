#include "razor/program/layer_options.h"

#include "razor/api/layers.h"
#include "razor/image/output.h"
#include "razor/program/arguments.h"
#include "razor/program/touch_meter.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {
void LayerOptions::add_to(CLI::App& render) {
    render
        .add_option("--layers", layers_,
                    "add layers to EXR files, for example pick,lod: pick (mesh, face, place on it), lod, "
                    "patch, kd (depth), steps (of traversal), bytes (touched), packet (utilisation), shading "
                    "(hits, shadow rays), time; all: these without time")
        ->type_name("LIST");
    render
        .add_option(
            "--false-colour", shown_,
            "PNG files show a layer in colours: one of a group of --layers, such as lod.level or "
            "steps.nodes (lod: its first), or depth.Z, or samples (of --noise-threshold); numbers that "
            "are names have a colour each")
        ->type_name("LAYER");
    render
        .add_option("--range", range_,
                    "of --false-colour, what is darkest and brightest; without it, least and most")
        ->type_name("LOW:HIGH");
    render.footer([] { return "Layers:\n" + describe_layers(); });
}

void LayerOptions::ask(RenderOptions& options, const std::vector<std::string>& outputs) const {
    const auto is_picture = [](const std::string& output) { return is_png(output); };
    if (!layers_.empty()) {
        options.layers = parse_layers("--layers", layers_, can_measure_touch());
        if (std::all_of(outputs.begin(), outputs.end(), is_picture))
            throw UserError("--layers go into EXR files; add -o FILE.exr");
    }
    if (!range_.empty() && shown_.empty())
        throw UserError("--range without --false-colour; leave it out");
    if (!shown_.empty()) {
        const Layer* const layer = find_layer(shown_name());
        if (layer != nullptr && layer->group == LayerGroup::bytes)
            parse_layers("--false-colour", "bytes", can_measure_touch());
        if (layer != nullptr)
            options.layers.add(layer->group);
        stated_range();
        if (std::none_of(outputs.begin(), outputs.end(), is_picture))
            throw UserError("--false-colour is of PNG files; add -o FILE.png");
    }
    if (options.layers.has(LayerSource::touch))
        options.touched = touch_meter();
}

std::string LayerOptions::shown_name() const {
    return api::plane_name("--false-colour", shown_);
}

std::optional<ValueRange> LayerOptions::stated_range() const {
    if (range_.empty())
        return {};
    const auto [low, high] = parse_bounds("--range", range_);
    return ValueRange{low, high};
}

Film LayerOptions::shown(const Film& film) const {
    return api::in_colours(film, shown_name(), stated_range());
}

std::string LayerOptions::legend(const Film& film) const {
    if (!shows())
        return "";
    const std::string name = shown_name();
    const Layer* const layer = find_layer(name);
    if (layer != nullptr && layer->names)
        return fmt::format("{}: a colour for each number; black: nothing\n", name);
    const ValueRange range = stated_range().value_or(api::plane_range(film, name));
    return fmt::format("{}: {:.6g} (dark) to {:.6g} (bright); black: nothing\n", name, range.low, range.high);
}

} // namespace razor
