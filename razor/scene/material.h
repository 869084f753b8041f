// What surfaces are made of: the metallic-roughness model of glTF 2.0 (appendix B) with its extensions for
// specular weight, index of refraction, clear coat and transmission. Colours are linear.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <string>

namespace razor {

/// A texture where a material uses it, at texture coordinates offset + R(rotation) (scale * uv)
/// (KHR_texture_transform, with v upwards).
struct TextureMap {
    int texture = -1; // index into Scene::textures; -1: none
    glm::vec2 scale{1, 1}, offset{0, 0};
    float rotation = 0; // radians, counter-clockwise

    bool operator==(const TextureMap&) const = default;
};

struct Material {
    std::string name;
    glm::vec3 albedo{0.7F, 0.7F,
                     0.7F};       // in [0, 1]: of diffuse reflection, or of a metal's at normal incidence
    float metallic = 0;           // in [0, 1]
    float roughness = 0.5F;       // in [0, 1]; its square is the width of the GGX distribution
    float specular = 0;           // in [0, 1]: weight of a dielectric's reflection; 0 (and no metal): matte
    float ior = 1.5F;             // index of refraction of a dielectric, in [1, 3]
    float transmission = 0;       // in [0, 1]: of what a dielectric does not reflect, so much goes through
    float coat = 0;               // in [0, 1]: weight of a clear coat of index 1.5 on top
    float coat_roughness = 0;     // in [0, 1]
    glm::vec3 sheen{0, 0, 0};     // in [0, 1]: of what fibres reflect at grazing angles, below the coat
    float sheen_roughness = 0.5F; // in [0, 1]; below 0.1 as 0.1
    glm::vec3 emission{0, 0, 0};  // radiance from both sides
    bool light = false;           // rays to lights go to what of it emits; else only bounces find that
    /// Maps multiply what is above: albedo, emission and sheen by colour, metallic by blue, roughness by
    /// green, sheen_roughness by opacity or, of pictures without and of patterns, by green.
    TextureMap albedo_map{}, metallic_map{}, roughness_map{}, emission_map{};
    TextureMap sheen_map{}, sheen_roughness_map{};
    TextureMap normal_map{}; // tangent-space normals, 2 rgb - 1
    float normal_scale = 1;  // of their x and y
    TextureMap bump_map{};   // heights, by luminance
    float bump = 0;          // how high its 1 lies over its 0, in units of the object
    /// Heights, of which surfaces are displaced along their normals by displacement_scale * (height -
    /// displacement_midlevel), in the mesh's own units: what scales an instance scales them.
    TextureMap displacement_map{};
    float displacement_scale = 1;
    float displacement_midlevel = 0.5F;
    float alpha_cutoff = 0; // what albedo_map's opacity is below is not there; 0: all is
    bool two_sided = true;  // else seen from the front only: see is_one_sided()

    bool operator==(const Material&) const = default;
};

inline bool has_sheen(const Material& m) {
    return m.sheen != glm::vec3(0);
}

/// Whether surfaces of it leave where their cage has them.
inline bool is_displaced(const Material& m) {
    return m.displacement_map.texture >= 0 && m.displacement_scale != 0;
}

/// Reflects light in all directions alike, and nothing else.
inline bool is_matte(const Material& m) {
    return m.metallic == 0 && m.specular == 0 && m.transmission == 0 && m.coat == 0 && !has_sheen(m);
}

/// Is there only for rays that come from the front, where its vertices run counter-clockwise. What lets light
/// through has two sides whatever is stated: light leaves it by the other.
inline bool is_one_sided(const Material& m) {
    return !m.two_sided && m.transmission == 0;
}

} // namespace razor
