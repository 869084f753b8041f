#include "razor/survey/tile_layers.h"

#include <algorithm>
#include <functional>

namespace razor {
namespace {

double utilisation(const Counters& c, int width) {
    return c.packets > 0 ? static_cast<double>(c.rays) / static_cast<double>(c.packets * width) : 0;
}

Counters shadows(const CountersByKind& c) {
    Counters both = c.kind[kind_light];
    both += c.kind[kind_sky];
    return both;
}

} // namespace

void add_tile_layers(const std::vector<TileCost>& costs, const FrameHeader& frame, int width,
                     const Crop& part, const LayerSet& layers, Film& film) {
    const auto add = [&](const char* name, const std::function<double(const TileCost&, double pixels)>& of) {
        const Layer& layer = *find_layer(name);
        if (!layers.has(layer.group))
            return;
        std::vector<float>& values = film.add(name).values;
        for (const TileCost& cost : costs) {
            const int x0 = cost.column * tile_side, y0 = cost.row * tile_side;
            const int x1 = std::min(x0 + tile_side, frame.width), y1 = std::min(y0 + tile_side, frame.height);
            const auto value = static_cast<float>(of(cost, static_cast<double>((x1 - x0) * (y1 - y0))));
            for (int y = std::max(y0, part.y); y < std::min(y1, part.y + part.height); ++y)
                for (int x = std::max(x0, part.x); x < std::min(x1, part.x + part.width); ++x)
                    values[static_cast<std::size_t>(y - part.y) * static_cast<std::size_t>(part.width) +
                           static_cast<std::size_t>(x - part.x)] = value;
        }
    };
    add("packet.utilisation",
        [&](const TileCost& c, double) { return utilisation(c.counters.sum(), width); });
    add("packet.camera",
        [&](const TileCost& c, double) { return utilisation(c.counters.kind[kind_camera], width); });
    add("packet.shadow", [&](const TileCost& c, double) { return utilisation(shadows(c.counters), width); });
    add("packet.bounce",
        [&](const TileCost& c, double) { return utilisation(c.counters.kind[kind_bounce], width); });
    add("shading.hits", [](const TileCost& c, double pixels) {
        const Counters all = c.counters.sum();
        return static_cast<double>(all.camera_hits + all.bounce_hits) / pixels;
    });
    add("shading.shadow_rays", [](const TileCost& c, double pixels) {
        return static_cast<double>(shadows(c.counters).rays) / pixels;
    });
    add("shading.bounces", [](const TileCost& c, double pixels) {
        return static_cast<double>(c.counters.kind[kind_bounce].rays) / pixels;
    });
    add("time.microseconds", [](const TileCost& c, double pixels) { return 1e6 * c.seconds / pixels; });
}

} // namespace razor
