// The members of a material by the names that scene files have for them, and what kinds of materials begin
// with.
#pragma once

#include "razor/scene/material.h"
#include "razor/scene/ranges.h"

#include <cstdint>
#include <string_view>

namespace razor {

/// What a scene file's material has where it states nothing else.
enum class MaterialKind : std::uint8_t { matte, principled, mirror, glass };

inline Material preset_material(MaterialKind kind) {
    Material m;
    switch (kind) {
    case MaterialKind::matte:
        break;
    case MaterialKind::principled:
        m.specular = 1;
        break;
    case MaterialKind::mirror:
        m.albedo = glm::vec3(1);
        m.metallic = 1;
        m.roughness = 0;
        break;
    case MaterialKind::glass:
        m.albedo = glm::vec3(1);
        m.specular = m.transmission = 1;
        m.roughness = 0;
        break;
    }
    return m;
}

/// Calls visit(name, range, member...) for each number and colour.
template <class Visit, class... Materials> void visit_material_fields(Visit visit, Materials&... m) {
    visit("albedo", unit_range, m.albedo...);
    visit("metallic", unit_range, m.metallic...);
    visit("roughness", unit_range, m.roughness...);
    visit("specular", unit_range, m.specular...);
    visit("ior", ior_range, m.ior...);
    visit("transmission", unit_range, m.transmission...);
    visit("coat", unit_range, m.coat...);
    visit("coat_roughness", unit_range, m.coat_roughness...);
    visit("sheen", unit_range, m.sheen...);
    visit("sheen_roughness", unit_range, m.sheen_roughness...);
    visit("emission", radiance_range, m.emission...);
    visit("normal_scale", normal_scale_range, m.normal_scale...);
    visit("bump", coordinate_range, m.bump...);
    visit("displacement_scale", displacement_range, m.displacement_scale...);
    visit("displacement_midlevel", displacement_range, m.displacement_midlevel...);
    visit("alpha_cutoff", unit_range, m.alpha_cutoff...);
}

/// Calls visit(name, map...) for each map.
template <class Visit, class... Materials> void visit_material_maps(Visit visit, Materials&... m) {
    visit("albedo_map", m.albedo_map...);
    visit("metallic_map", m.metallic_map...);
    visit("roughness_map", m.roughness_map...);
    visit("emission_map", m.emission_map...);
    visit("sheen_map", m.sheen_map...);
    visit("sheen_roughness_map", m.sheen_roughness_map...);
    visit("normal_map", m.normal_map...);
    visit("bump_map", m.bump_map...);
    visit("displacement_map", m.displacement_map...);
}

} // namespace razor
