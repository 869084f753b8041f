#include "razor/program/study/scene_knobs.h"

#include "analysis/study/point.h"
#include "razor/program/arguments.h"
#include "razor/program/scene_options.h"
#include "razor/scene/error.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"
#include "razor/scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace razor {
namespace {

namespace fs = std::filesystem;
using analysis::plain_text;
using analysis::toml_text;
using analysis::Value;

template <class Meaning, std::size_t Count>
std::vector<std::string_view> words_of(const std::array<Word<Meaning>, Count>& words) {
    std::vector<std::string_view> out;
    for (const auto& [word, meaning] : words)
        out.push_back(word);
    return out;
}

SceneKnob whole(std::string_view key, std::string_view option, Range range) {
    return {SceneKnob::whole, key, option, range.least, range.most};
}
SceneKnob number(std::string_view key, std::string_view option, Range range) {
    return {SceneKnob::number, key, option, range.least, range.most};
}

std::vector<SceneKnob> make_knobs() {
    return {{SceneKnob::text, "scene", ""},
            {SceneKnob::text, "size", "--size"},
            {SceneKnob::text, "crop", "--crop"},
            whole("frame", "--frame", frame_range),
            whole("samples", "--spp", samples_range),
            number("noise_threshold", "--noise-threshold", noise_threshold_range),
            {SceneKnob::text, "filter", "--filter", 0, 0, words_of(filter_words)},
            number("filter_radius", "--filter-radius", filter_radius_range),
            whole("light_samples", "--light-samples", shadow_samples_range),
            whole("light_choices", "--light-choices", light_choices_range),
            whole("sky_samples", "--sky-samples", shadow_samples_range),
            whole("bounces", "--bounces", bounces_range),
            whole("diffuse_bounces", "--diffuse-bounces", bounces_range),
            number("edge_pixels", "--edge-pixels", edge_pixels_range),
            {SceneKnob::text, "shading", "--shading", 0, 0, words_of(shading_words)},
            {SceneKnob::text, "lod", "--lod", 0, 0, words_of(lod_words)},
            {SceneKnob::text, "scheme", "--scheme", 0, 0, words_of(scheme_words)},
            {SceneKnob::text, "up", "--up", 0, 0, {"y", "z"}},
            {SceneKnob::flag, "no_floor", "--no-floor"},
            {SceneKnob::flag, "everything", "--everything"}};
}

const SceneKnob* find_knob(std::string_view key) {
    const auto& all = scene_knobs();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const SceneKnob& knob) { return knob.key == key; });
    return found == all.end() ? nullptr : &*found;
}

/// Of a picture's size, and of a part of it, which must lie in what each point's size is.
std::string wrong_numbers(std::string_view key, const std::string& text) {
    try {
        if (key == "size")
            parse_size(key, text, size_range);
        if (key == "crop")
            if (const auto part = parse_four(key, text, crop_range); part[2] == 0 || part[3] == 0)
                return fmt::format("crop '{}' has no pixels; give X,Y,WIDTH,HEIGHT", printable(text));
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

/// What is wrong with an option, of the setting that it stands for.
std::string in_words_of_studies(const std::string& wrong) {
    for (const SceneKnob& knob : scene_knobs()) {
        const std::string option(knob.option);
        if (!option.empty() && wrong.starts_with(option) &&
            (wrong[option.size()] == ':' || wrong[option.size()] == ' '))
            return std::string(knob.key) + wrong.substr(option.size());
    }
    return wrong;
}

/// Of files that name nothing else.
std::string bytes_digest(const fs::path& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored) && fs::file_size(file, ignored) > 0
               ? analysis::point_name(read_text_file(file, "a file of a scene"))
               : "-";
}

} // namespace

const std::vector<SceneKnob>& scene_knobs() {
    static const std::vector<SceneKnob> all = make_knobs();
    return all;
}

std::optional<std::string> wrong_scene_setting(std::string_view key, Value& value) {
    const SceneKnob* const knob = find_knob(key);
    if (knob == nullptr)
        return {};
    switch (knob->kind) {
    case SceneKnob::whole:
        return wrong_whole(key, value, knob->least, knob->most);
    case SceneKnob::number:
        return wrong_number(key, value, knob->least, knob->most);
    case SceneKnob::flag:
        return std::holds_alternative<bool>(value) ? ""
                                                   : fmt::format("{} is no flag; write true or false", key);
    case SceneKnob::text:
        break;
    }
    std::string wrong = wrong_word(key, value, knob->words);
    return wrong.empty() ? wrong_numbers(key, std::get<std::string>(value)) : wrong;
}

std::string no_scene_setting(std::string_view key, const std::vector<std::string_view>& others) {
    std::vector<std::string_view> known = others;
    for (const SceneKnob& knob : scene_knobs()) {
        if (knob.option == fmt::format("--{}", key))
            return fmt::format("{} is {} among the settings of studies; write that", printable(key),
                               knob.key);
        known.push_back(knob.key);
    }
    return no_setting(key, known);
}

SceneDescription describe_scene(const analysis::Settings& settings, const fs::path& folder) {
    SceneOptions options;
    CLI::App app;
    options.add_to(app, "scene");
    std::vector<std::string> words;
    for (const SceneKnob& knob : scene_knobs()) {
        const auto found = settings.find(std::string(knob.key));
        if (found == settings.end() || found->second == Value(false))
            continue;
        if (knob.key == "scene") {
            words.push_back((folder / plain_text(found->second)).string());
            continue;
        }
        words.emplace_back(knob.option);
        if (knob.kind != SceneKnob::flag)
            words.push_back(plain_text(found->second));
    }
    std::reverse(words.begin(), words.end()); // as CLI11 takes them
    app.parse(words);
    try {
        return options.describe();
    } catch (const UserError& error) {
        throw UserError(in_words_of_studies(error.what()));
    }
}

analysis::Settings with_defaults(analysis::Settings settings, const SceneDescription& scene) {
    const razor::Settings& s = scene.settings;
    const analysis::Settings own{{"size", fmt::format("{}x{}", s.width, s.height)},
                                 {"samples", std::int64_t{s.samples}},
                                 {"noise_threshold", s.noise_threshold},
                                 {"light_samples", std::int64_t{s.light_samples}},
                                 {"light_choices", std::int64_t{s.light_choices}},
                                 {"sky_samples", std::int64_t{s.sky_samples}},
                                 {"bounces", std::int64_t{s.bounces}},
                                 {"diffuse_bounces", std::int64_t{s.diffuse_bounces}},
                                 {"edge_pixels", s.edge_pixels},
                                 {"shading", std::string(word_of(shading_words, s.shading))},
                                 {"lod", std::string(word_of(lod_words, s.lod))},
                                 {"filter", std::string(word_of(filter_words, s.filter.kind))}};
    return analysis::overlaid(own, settings);
}

std::string scene_digest(const analysis::Settings& settings, const fs::path& folder,
                         const SceneDescription& scene) {
    std::set<std::string> files; // each once, in an order that places on a machine do not change
    for (const MeshDescription& mesh : scene.meshes)
        files.insert(mesh.file);
    for (const Texture& texture : scene.textures)
        files.insert(texture.file);
    std::vector<const std::vector<ObjectDescription>*> lists{&scene.objects};
    for (const GroupDescription& group : scene.groups)
        lists.push_back(&group.objects);
    for (const auto* list : lists)
        for (const ObjectDescription& object : *list)
            files.insert(object.instances);
    std::string all;
    if (const auto found = settings.find("scene"); found != settings.end())
        all += bytes_digest(folder / plain_text(found->second));
    else
        all += analysis::point_name(to_toml(scene)); // the built-in scene, which names no files
    std::set<std::string> contents;
    for (const std::string& file : files)
        if (!file.empty())
            contents.insert(fmt::format("{} {}", fs::path(file).filename().string(), bytes_digest(file)));
    for (const std::string& one : contents)
        all += "\n" + one;
    return analysis::point_name(all);
}

std::string changed_scene(const analysis::Settings& settings, const fs::path& folder,
                          const std::string& digest) {
    try {
        if (scene_digest(settings, folder, describe_scene(settings, folder)) == digest)
            return "";
    } catch (const std::exception&) {
        // It cannot be read any more.
    }
    const auto scene = settings.find("scene");
    return scene == settings.end() ? "the scene" : (folder / plain_text(scene->second)).string();
}

} // namespace razor
