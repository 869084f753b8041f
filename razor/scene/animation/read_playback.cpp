#include "razor/scene/animation/read_playback.h"

#include "razor/scene/animation/read_keys.h"
#include "razor/scene/models/cage_source.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"
#include "razor/scene/toml_text.h"
#include "razor/scene/toml_words.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace razor {
namespace {

constexpr Range moment_range{-1e9, 1e9}; // seconds
constexpr Range speed_range{-1e3, 1e3};  // seconds a second
constexpr Range period_range{0, 1e6};    // seconds
constexpr Range phase_range{-1e6, 1e6};  // turns
constexpr Range length_range{1e-30, 1e30};

/// What can be said of a file's motion.
struct PlaybackKeys {
    bool frames, clip;
};

PlaybackKeys keys_of(const MeshDescription& mesh) {
    const ModelFile kind = mesh.file.empty() ? ModelFile::none : model_file(mesh.file);
    return {kind == ModelFile::sequence || kind == ModelFile::md3, kind == ModelFile::gltf};
}

Deformer read_deformer(TomlTable table) {
    Deformer d;
    if (!table.has("kind"))
        table.fail("kind", "a deformation without a kind; write kind = \"wave\", \"twist\" or \"bend\"");
    d.kind = choose(table, "kind", d.kind, deformer_words);
    d.origin = table.vector("origin", d.origin, coordinate_range);
    d.axis = table.vector("axis", d.axis, coordinate_range);
    d.amount = table.number("amount", d.amount, coordinate_range);
    d.period = table.number("period", d.period, period_range);
    d.phase = table.number("phase", d.phase, phase_range);
    if (d.kind != DeformerKind::twist)
        d.direction = table.vector("direction", d.direction, coordinate_range);
    if (d.kind == DeformerKind::wave)
        d.wavelength = table.number("wavelength", d.wavelength, length_range);
    table.finish();
    // As large as coordinates get, squares still are finite.
    if (!(glm::length(d.axis) > 0))
        table.fail("axis", "the axis has no length; give it a direction");
    if (d.kind == DeformerKind::wave && !(glm::length(d.direction) > 0))
        table.fail("direction", "the direction has no length; give it one");
    if (d.kind == DeformerKind::bend &&
        !(glm::length(glm::cross(glm::normalize(d.axis), d.direction)) > 1e-9 * glm::length(d.direction)))
        table.fail("direction", "the direction is along the axis, or has no length; turn it");
    return d;
}

/// What a motion's own seconds are.
void read_seconds(TomlTable& table, Playback& p) {
    for (const std::string_view name : {"start", "speed"})
        if (table.has(name) && table.has("moment"))
            table.fail(name, fmt::format("{} and moment, at which all stands still; leave one out", name));
    p.start = table.number("start", p.start, moment_range);
    p.speed = table.number("speed", p.speed, speed_range);
    if (table.has("moment"))
        p.moment = table.number("moment", 0, moment_range);
    table.may_have("moment");
}

std::string seconds_to_toml(const Playback& p) {
    return p.moment ? fmt::format("moment = {}\n", toml_number(*p.moment))
                    : fmt::format("start = {}\nspeed = {}\n", toml_number(p.start), toml_number(p.speed));
}

} // namespace

void read_playback(TomlTable& table, MeshDescription& mesh, const std::filesystem::path& folder,
                   double frame_rate) {
    for (TomlTable& deformer : table.tables("deform"))
        mesh.deformers.push_back(read_deformer(std::move(deformer)));
    const PlaybackKeys keys = keys_of(mesh);
    Playback& p = mesh.playback;
    const auto only = [&](std::initializer_list<std::string_view> names, bool allowed,
                          std::string_view mend) {
        for (const std::string_view name : names) {
            if (!allowed && table.has(name))
                table.fail(name, fmt::format("{} in a mesh {}", name, mend));
            table.may_have(name);
        }
    };
    only({"frames", "frame_rate", "interpolation"}, keys.frames,
         "whose file has no frames; give an .md3 model, or write %d in the name of .obj or .ply files, "
         "where the number of the frame comes");
    only({"clip", "clip_file"}, keys.clip, "whose file has no clips; give a .gltf or .glb model");
    only({"cycle"}, keys.frames || keys.clip, "whose file does not move; leave it out");
    only({"start", "speed", "moment"}, keys.frames || keys.clip || !mesh.deformers.empty(),
         "that does not change its shape; leave it out");
    if (keys.frames) {
        if (table.has("frames")) {
            p.frames = table.whole_pair("frames", {0, 0}, frame_range);
            if (p.frames->first > p.frames->second)
                table.fail("frames", fmt::format("frames from {} to {}; write the first one first",
                                                 p.frames->first, p.frames->second));
        }
        p.frame_rate = table.number("frame_rate", frame_rate, frame_rate_range);
        p.timing.interpolation = choose(table, "interpolation", p.timing.interpolation, interpolation_words);
    }
    if (keys.frames || keys.clip)
        p.timing.cycle = table.number("cycle", 0, time_range);
    if (keys.clip)
        p.clip = table.text("clip", "");
    if (keys.clip && table.has("clip_file")) {
        const std::string file = table.text("clip_file", "");
        if (model_file(file) != ModelFile::gltf)
            table.fail("clip_file",
                       fmt::format("'{}' has no clips; give a .gltf or .glb file", printable(file, 1000)));
        p.clip_file = std::filesystem::absolute(folder / file).lexically_normal().string();
    }
    read_seconds(table, p);
}

void check_cycle(const TomlTable& table, const Playback& p) {
    if (!p.frames || p.timing.cycle == 0)
        return;
    const double last = (p.frames->second - p.frames->first) / p.frame_rate;
    if (last > p.timing.cycle)
        table.fail("cycle",
                   fmt::format("frames {} to {}, {} a second, of which the last is at {} s of a cycle "
                               "of {} s; make the cycle longer, or play fewer frames",
                               p.frames->first, p.frames->second, p.frame_rate, last, p.timing.cycle));
}

void read_clip_playback(TomlTable& table, Playback& playback) {
    playback.clip = table.text("clip", "");
    playback.timing.cycle = table.number("cycle", 0, time_range);
    read_seconds(table, playback);
}

std::string clip_playback_to_toml(const Playback& p) {
    return (p.clip.empty() ? "" : fmt::format("clip = {}\n", toml_text(p.clip))) +
           fmt::format("cycle = {}\n", toml_number(p.timing.cycle)) + seconds_to_toml(p);
}

std::string playback_to_toml(const MeshDescription& mesh) {
    const PlaybackKeys keys = keys_of(mesh);
    const Playback& p = mesh.playback;
    std::string text;
    if (keys.frames)
        text += fmt::format("frames = [{}, {}]\nframe_rate = {}\ninterpolation = {}\n", p.frames->first,
                            p.frames->second, toml_number(p.frame_rate),
                            toml_text(word_of(interpolation_words, p.timing.interpolation)));
    if (!p.clip_file.empty())
        text += fmt::format("clip_file = {}\n", toml_text(p.clip_file));
    if (!p.clip.empty())
        text += fmt::format("clip = {}\n", toml_text(p.clip));
    if (keys.frames || keys.clip)
        text += fmt::format("cycle = {}\n", toml_number(p.timing.cycle));
    if (keys.frames || keys.clip || !mesh.deformers.empty())
        text += seconds_to_toml(p);
    return text;
}

std::string deformers_to_toml(const MeshDescription& mesh) {
    std::string text;
    for (const Deformer& d : mesh.deformers) {
        text +=
            fmt::format("[[mesh.deform]]\nkind = {}\norigin = {}\naxis = {}\n",
                        toml_text(word_of(deformer_words, d.kind)), toml_value(d.origin), toml_value(d.axis));
        if (d.kind != DeformerKind::twist)
            text += fmt::format("direction = {}\n", toml_value(d.direction));
        text += fmt::format("amount = {}\n", toml_number(d.amount));
        if (d.kind == DeformerKind::wave)
            text += fmt::format("wavelength = {}\n", toml_number(d.wavelength));
        text += fmt::format("period = {}\nphase = {}\n", toml_number(d.period), toml_number(d.phase));
    }
    return text;
}

} // namespace razor
