#include "razor/program/scene_options.h"

#include "razor/program/arguments.h"
#include "razor/scene/animation/pose.h"
#include "razor/scene/crop.h"
#include "razor/scene/default_scene.h"
#include "razor/scene/error.h"
#include "razor/scene/models/model_file.h"
#include "razor/scene/scene_file.h"
#include "razor/scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace razor {
namespace {

template <class Value, std::size_t N>
Value parse_word(const char* option, std::string_view word,
                 const std::array<std::pair<std::string_view, Value>, N>& choices) {
    std::array<std::string_view, N> words;
    std::transform(choices.begin(), choices.end(), words.begin(),
                   [](const auto& entry) { return entry.first; });
    return choices[parse_choice(option, word, words)].second;
}

Scheme parse_scheme(std::string_view word) {
    return parse_word("--scheme", word, scheme_words);
}
LevelOfDetail parse_lod(std::string_view word) {
    return parse_word("--lod", word, lod_words);
}

} // namespace

void SceneOptions::add_to(CLI::App& app, const std::string& scene_name) {
    app.add_option(scene_name, scene_,
                   "a scene file (.toml), a model (.obj, .ply, .md3, .gltf, .glb) or a table of them "
                   "(.instances); without one, the built-in scene")
        ->type_name("FILE");
    app.add_option("--size", size_, "the picture's size in pixels")->type_name("WxH");
    app.add_option("--crop", crop_,
                   "render this part of the picture alone, pixels from its top left corner, to a file of its "
                   "size")
        ->type_name("X,Y,W,H");
    app.add_option("--spp", samples_, "camera samples a pixel")->type_name("N");
    app.add_option("--noise-threshold", noise_threshold_,
                   "take samples where there is noise: of each screen tile until the error of its luminance "
                   "is found to be no more than this times the luminance's square root, from 16 to --spp; "
                   "0.02 is hardly seen; without it, or 0, --spp everywhere")
        ->type_name("X");
    app.add_option(
           "--filter", filter_,
           "what pixels are of the light about them: box (the default, of the pixel alone), triangle, "
           "gaussian, mitchell or lanczos, with pbrt's parameters")
        ->type_name("NAME");
    app.add_option("--filter-radius", filter_radius_,
                   "how far about a pixel's middle its filter reaches, in "
                   "pixels")
        ->type_name("R");
    app.add_option("--light-samples", light_samples_, "shadow rays a hit to each light")->type_name("N");
    app.add_option(
           "--light-choices", light_choices_,
           "where there are more than twelve times so many lights, so many shadow rays a hit, to lights "
           "that are chosen by what they may give; 0: always some to each")
        ->type_name("N");
    app.add_option("--sky-samples", sky_samples_, "shadow rays a hit to the sky")->type_name("N");
    app.add_option("--bounces", bounces_, "reflections and refractions in a row that are followed")
        ->type_name("N");
    app.add_option("--diffuse-bounces", diffuse_bounces_,
                   "the first so many of them also of light that goes in all directions")
        ->type_name("N");
    app.add_option("--seed", seed_,
                   "of all samples and random rays: pictures of different seeds differ in noise alone")
        ->type_name("N");
    app.add_option("--edge-pixels", edge_pixels_, "target length of tessellated edges, in pixels")
        ->type_name("X");
    app.add_option(
           "--shading", shading_,
           "where textures are evaluated: grids (at vertices of what camera rays hit, as far as there are "
           "some; the default), hits, or diced (as grids, flat faces being cut for it)")
        ->type_name("WHERE");
    app.add_option(
           "--lod", lod_,
           "levels of detail: recursive (every ray its own), discrete (the same without blending), "
           "patch (one level a patch and ray), paper (pairs of levels along each ray), camera (all rays the "
           "camera's), object (each instance at the level of its nearest point), fixed (each mesh at the "
           "finest "
           "of its instances'), object:K or fixed:K (K levels coarser)")
        ->type_name("NAME");
    app.add_option("--frame", frame_, "of what moves, this moment, counted from 0; without it, 0")
        ->type_name("N");
    app.add_option("--scheme", scheme_, "surfaces of all meshes: catmark or bilinear")->type_name("NAME");
    app.add_option(
           "--crease-angle", crease_angle_,
           "of an MD3 or glTF model: edges stay hard where normals of the file differ by more than so many "
           "degrees between their faces; without it none does")
        ->type_name("DEGREES");
    app.add_option("--up", up_, "the axis of a model file that points up: y or z")->type_name("AXIS");
    app.add_flag("--no-floor", no_floor_, "put no floor under a model file");
    app.add_flag("--everything", everything_,
                 "run kernels that can do all that any scene may need, to compare with: the same picture");
}

SceneDescription SceneOptions::describe() const {
    const int asked = frame(); // a wrong one is found before any file is read
    return pose_of_frame(describe_moving(), asked);
}

int SceneOptions::frame() const {
    return frame_.empty() ? 0 : parse_whole("--frame", frame_, frame_range);
}

SceneDescription SceneOptions::describe_alone() const {
    const int asked = frame();
    return pose_of_frame(describe_moving(false), asked);
}

SceneDescription SceneOptions::describe_moving() const {
    return describe_moving(!no_floor_);
}

SceneDescription SceneOptions::describe_moving(bool floor) const {
    // Wrong values are found before any file is read.
    const auto override_settings = [this](Settings& settings) {
        if (!size_.empty()) {
            std::tie(settings.width, settings.height) = parse_size("--size", size_, size_range);
        }
        if (!crop_.empty()) {
            const auto [x, y, width, height] = parse_four("--crop", crop_, crop_range);
            settings.crop = {x, y, width, height};
        }
        if (!samples_.empty()) {
            settings.samples = parse_whole("--spp", samples_, samples_range);
        }
        if (!noise_threshold_.empty()) {
            settings.noise_threshold =
                parse_number("--noise-threshold", noise_threshold_, noise_threshold_range);
        }
        if (!filter_.empty()) {
            settings.filter = preset_filter(parse_word("--filter", filter_, filter_words));
        }
        if (!filter_radius_.empty()) {
            const double radius = parse_number("--filter-radius", filter_radius_, filter_radius_range);
            settings.filter.radius = {radius, radius};
        }
        if (!light_samples_.empty()) {
            settings.light_samples = parse_whole("--light-samples", light_samples_, shadow_samples_range);
        }
        if (!light_choices_.empty()) {
            settings.light_choices = parse_whole("--light-choices", light_choices_, light_choices_range);
        }
        if (!sky_samples_.empty()) {
            settings.sky_samples = parse_whole("--sky-samples", sky_samples_, shadow_samples_range);
        }
        if (!bounces_.empty()) {
            settings.bounces = parse_whole("--bounces", bounces_, bounces_range);
        }
        if (!diffuse_bounces_.empty()) {
            settings.diffuse_bounces = parse_whole("--diffuse-bounces", diffuse_bounces_, bounces_range);
        }
        settings.everything = everything_;
        if (!seed_.empty()) {
            settings.seed = parse_whole("--seed", seed_, seed_range);
        }
        if (!edge_pixels_.empty()) {
            settings.edge_pixels = parse_number("--edge-pixels", edge_pixels_, edge_pixels_range);
        }
        if (!shading_.empty()) {
            settings.shading = parse_word("--shading", shading_, shading_words);
        }
        if (!lod_.empty()) {
            settings.lod = parse_lod(lod_);
        }
    };
    FramingOptions framing;
    override_settings(framing.settings);
    constexpr std::array<std::string_view, 2> axes{"y", "z"};
    framing.up = parse_choice("--up", up_, axes) == 0 ? Up::y : Up::z;
    framing.floor = floor;
    const bool bare = !scene_.empty() && !scene_.ends_with(".toml");
    if (!bare && framing.up != Up::y) {
        throw UserError(
            "--up z: turns bare models; leave it out, or rotate = [-90, 0, 0] in the scene file's [[mesh]]");
    }
    if (!bare && no_floor_) {
        throw UserError("--no-floor: only bare models are given a floor; leave it out");
    }
    if (!crease_angle_.empty()) {
        framing.crease_angle = parse_number("--crease-angle", crease_angle_, {0, no_crease_angle});
        if (!has_split_points(scene_)) {
            throw UserError(
                fmt::format("--crease-angle: only MD3 and glTF models have normals instead of creases; {}",
                            bare ? "leave it out" : "state crease_angle in the [[mesh]] of one"));
        }
    }
    if (!scheme_.empty()) {
        framing.scheme = parse_scheme(scheme_);
    }
    const bool built_in = scene_.empty();
    SceneDescription scene = built_in ? default_scene() : razor::describe(scene_, framing);
    override_settings(scene.settings);
    // Of either the file or the options, the other may have changed what it must lie in.
    const std::string wrong =
        mistake_of_crop(crop_.empty() ? shown_part(scene.settings) : scene.settings.crop, scene.settings);
    if (!wrong.empty()) {
        throw UserError(fmt::format("{}: {}", crop_.empty() ? scene_ : "--crop", wrong));
    }
    const bool model = !built_in && is_model_file(scene_);
    if (!scheme_.empty() && !model) { // a model's own scheme is set; its floor stays bilinear
        for (MeshDescription& mesh : scene.meshes) {
            mesh.scheme = framing.scheme;
        }
    }
    return scene;
}

} // namespace razor
