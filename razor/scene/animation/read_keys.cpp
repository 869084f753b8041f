#include "razor/scene/animation/read_keys.h"

#include "razor/scene/ranges.h"
#include "razor/scene/toml_text.h"
#include "razor/scene/toml_words.h"

#include <fmt/format.h>

#include <set>
#include <utility>

namespace razor {
namespace {

// One of them for each kind of keys: visit(name, track, range, whether one number stands for all three).
template <class Keys, class Visit>
requires std::same_as<std::remove_const_t<Keys>, TransformKeys>
void visit_tracks(Keys& k, Visit visit) {
    visit("scale", k.scale, signed_scale_range, true);
    visit("rotate", k.rotate, angle_range, false);
    visit("translate", k.translate, coordinate_range, false);
}
template <class Keys, class Visit>
requires std::same_as<std::remove_const_t<Keys>, CameraKeys>
void visit_tracks(Keys& k, Visit visit) {
    visit("position", k.position, coordinate_range, false);
    visit("target", k.target, coordinate_range, false);
    visit("up", k.up, coordinate_range, false);
    if (k.projection == Projection::orthographic) {
        visit("height", k.height, height_range, false);
        return;
    }
    visit("fov", k.fov, fov_range, false);
    visit("aperture_radius", k.aperture_radius, aperture_range, false);
    visit("focus_distance", k.focus_distance, focus_range, false);
}
template <class Keys, class Visit>
requires std::same_as<std::remove_const_t<Keys>, LightKeys>
void visit_tracks(Keys& k, Visit visit) {
    visit_light_fields(
        k.kind,
        [&](std::string_view name, Range range, bool or_number, auto& track) {
            visit(name, track, range, or_number);
        },
        k);
}

void read_value(TomlTable& key, std::string_view name, double time, Track<double>& track, Range range, bool) {
    if (key.has(name))
        track.keys.push_back({time, key.number(name, 0, range)});
    key.may_have(name);
}
void read_value(TomlTable& key, std::string_view name, double time, Track<glm::dvec3>& track, Range range,
                bool or_number) {
    if (key.has(name))
        track.keys.push_back({time, or_number ? key.vector_or_number(name, glm::dvec3(0), range)
                                              : key.vector(name, glm::dvec3(0), range)});
    key.may_have(name);
}

Timing read_timing(TomlTable& table, bool keys) {
    Timing timing;
    for (const std::string_view key : {"interpolation", "cycle"})
        if (!keys && table.has(key))
            table.fail(key, fmt::format("{} without keys; write [[{}.key]] with a time and what moves", key,
                                        table.name()));
    timing.interpolation = choose(table, "interpolation", timing.interpolation, interpolation_words);
    timing.cycle = table.number("cycle", 0, time_range);
    return timing;
}

template <class Keys> Keys read_keys(TomlTable& table, Keys keys = {}) {
    std::vector<TomlTable> tables = table.tables("key");
    keys.timing = read_timing(table, !tables.empty());
    double last = -1;
    for (TomlTable& key : tables) {
        if (!key.has("time"))
            key.fail("time", "a key without a time; write time = seconds");
        const double time = key.number("time", 0, time_range);
        if (time <= last)
            key.fail("time",
                     fmt::format("a key at {} s after one at {} s; put keys in order of time", time, last));
        if (keys.timing.cycle > 0 && time > keys.timing.cycle)
            key.fail("time", fmt::format("a key at {} s of a cycle of {} s; make the cycle longer", time,
                                         keys.timing.cycle));
        last = time;
        std::size_t values = 0;
        visit_tracks(keys, [&](std::string_view name, auto& track, Range range, bool or_number) {
            values += key.has(name) ? 1 : 0;
            read_value(key, name, time, track, range, or_number);
        });
        key.finish();
        if (values == 0)
            key.fail("time", "a key that says nothing but its time; write what is where then");
    }
    return keys;
}

template <class Keys> std::string print_keys(const Keys& keys, std::string_view header) {
    if (!keys.any())
        return "";
    std::set<double> times;
    const auto each_key = [&](auto visit) {
        visit_tracks(keys, [&](std::string_view name, const auto& track, Range, bool) {
            for (const auto& key : track.keys)
                visit(name, key.time, key.value);
        });
    };
    each_key([&](std::string_view, double time, const auto&) { times.insert(time); });
    std::string text = fmt::format("interpolation = {}\ncycle = {}\n",
                                   toml_text(word_of(interpolation_words, keys.timing.interpolation)),
                                   toml_number(keys.timing.cycle));
    for (const double now : times) {
        text += fmt::format("[[{}.key]]\ntime = {}\n", header, toml_number(now));
        each_key([&](std::string_view name, double time, const auto& value) {
            if (time == now)
                text += fmt::format("{} = {}\n", name, toml_value(value));
        });
    }
    return text;
}

} // namespace

TransformKeys read_transform_keys(TomlTable& table) {
    return read_keys<TransformKeys>(table);
}
CameraKeys read_camera_keys(TomlTable& table, Projection projection) {
    CameraKeys keys;
    keys.projection = projection;
    return read_keys(table, std::move(keys));
}
LightKeys read_light_keys(TomlTable& table, LightKind kind) {
    LightKeys keys;
    keys.kind = kind;
    return read_keys(table, std::move(keys));
}
std::string to_toml(const TransformKeys& keys, std::string_view header) {
    return print_keys(keys, header);
}
std::string to_toml(const CameraKeys& keys, std::string_view header) {
    return print_keys(keys, header);
}
std::string to_toml(const LightKeys& keys, std::string_view header) {
    return print_keys(keys, header);
}

} // namespace razor
