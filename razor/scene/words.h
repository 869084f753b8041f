// The words for choices in scene files and on the command line.
#pragma once

#include "razor/scene/animation/deformer.h"
#include "razor/scene/animation/track.h"
#include "razor/scene/material_fields.h"
#include "razor/scene/scene.h"

#include <array>
#include <span>
#include <string_view>
#include <utility>

namespace razor {

template <typename Value> using Word = std::pair<std::string_view, Value>;

inline constexpr std::array<Word<Scheme>, 2> scheme_words{{
    {"catmark", Scheme::catmull_clark},
    {"bilinear", Scheme::bilinear},
}};

inline constexpr std::array<Word<LevelOfDetail>, 23> lod_words{{
    {"recursive", {Lod::recursive}}, {"discrete", {Lod::discrete}},  {"patch", {Lod::patch}},
    {"paper", {Lod::paper}},         {"camera", {Lod::camera}},      {"object", {Lod::object}},
    {"object:1", {Lod::object, 1}},  {"object:2", {Lod::object, 2}}, {"object:3", {Lod::object, 3}},
    {"object:4", {Lod::object, 4}},  {"object:5", {Lod::object, 5}}, {"object:6", {Lod::object, 6}},
    {"object:7", {Lod::object, 7}},  {"object:8", {Lod::object, 8}}, {"fixed", {Lod::fixed}},
    {"fixed:1", {Lod::fixed, 1}},    {"fixed:2", {Lod::fixed, 2}},   {"fixed:3", {Lod::fixed, 3}},
    {"fixed:4", {Lod::fixed, 4}},    {"fixed:5", {Lod::fixed, 5}},   {"fixed:6", {Lod::fixed, 6}},
    {"fixed:7", {Lod::fixed, 7}},    {"fixed:8", {Lod::fixed, 8}},
}};

inline constexpr std::array<Word<FilterKind>, 5> filter_words{{
    {"box", FilterKind::box},
    {"triangle", FilterKind::triangle},
    {"gaussian", FilterKind::gaussian},
    {"mitchell", FilterKind::mitchell},
    {"lanczos", FilterKind::lanczos},
}};

inline constexpr std::array<Word<PatternKind>, 6> pattern_words{{
    {"checker", PatternKind::checker},
    {"bricks", PatternKind::bricks},
    {"noise", PatternKind::noise},
    {"turbulence", PatternKind::turbulence},
    {"marble", PatternKind::marble},
    {"wood", PatternKind::wood},
}};

inline constexpr std::array<Word<PatternSpace>, 2> pattern_space_words{{
    {"object", PatternSpace::object},
    {"texture", PatternSpace::texture},
}};

inline constexpr std::array<Word<Shading>, 3> shading_words{{
    {"grids", Shading::grids},
    {"hits", Shading::hits},
    {"diced", Shading::diced},
}};

inline constexpr std::array<Word<Projection>, 2> projection_words{{
    {"perspective", Projection::perspective},
    {"orthographic", Projection::orthographic},
}};

inline constexpr std::array<Word<LightKind>, 6> light_words{{
    {"rectangle", LightKind::rectangle},
    {"disk", LightKind::disk},
    {"sphere", LightKind::sphere},
    {"point", LightKind::point},
    {"spot", LightKind::spot},
    {"directional", LightKind::directional},
}};

inline constexpr std::array<Word<Wrap>, 3> wrap_words{{
    {"repeat", Wrap::repeat},
    {"clamp", Wrap::clamp},
    {"mirror", Wrap::mirror},
}};

inline constexpr std::array<Word<MaterialKind>, 4> material_words{{
    {"matte", MaterialKind::matte},
    {"principled", MaterialKind::principled},
    {"mirror", MaterialKind::mirror},
    {"glass", MaterialKind::glass},
}};

/// What the values of a texture's file are: `linear` of Texture.
inline constexpr std::array<Word<bool>, 2> color_space_words{{
    {"srgb", false},
    {"linear", true},
}};

inline constexpr std::array<Word<Interpolation>, 3> interpolation_words{{
    {"step", Interpolation::step},
    {"linear", Interpolation::linear},
    {"smooth", Interpolation::smooth},
}};

inline constexpr std::array<Word<DeformerKind>, 3> deformer_words{{
    {"wave", DeformerKind::wave},
    {"twist", DeformerKind::twist},
    {"bend", DeformerKind::bend},
}};

/// The word for `value`, which must be in the table.
template <typename Value, std::size_t Count>
constexpr std::string_view word_of(const std::array<Word<Value>, Count>& words, Value value) {
    for (const auto& [word, meaning] : words) {
        if (meaning == value) {
            return word;
        }
    }
    return {};
}

} // namespace razor
