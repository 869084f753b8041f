#include "razor/scene/read_film.h"

#include "razor/scene/filter_fields.h"
#include "razor/scene/toml_text.h"
#include "razor/scene/toml_words.h"

#include <fmt/format.h>

namespace razor {
Filter read_filter(TomlTable table) {
    Filter filter = preset_filter(choose(table, "filter", FilterKind::box, filter_words));
    const auto [x, y] = table.pair("radius", {filter.radius.x, filter.radius.y}, filter_radius_range);
    filter.radius = {x, y};
    visit_filter_parameters(filter, [&](std::string_view name, double& value, Range range) {
        value = table.number(name, value, range);
    });
    table.finish();
    return filter;
}

std::string to_toml(const Filter& filter) {
    std::string text = fmt::format("\n[film]\nfilter = {}\nradius = [{}, {}]\n",
                                   toml_text(word_of(filter_words, filter.kind)),
                                   toml_number(filter.radius.x), toml_number(filter.radius.y));
    visit_filter_parameters(filter, [&](std::string_view name, double value, Range) {
        text += fmt::format("{} = {}\n", name, toml_number(value));
    });
    return text;
}

} // namespace razor
