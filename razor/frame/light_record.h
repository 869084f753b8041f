// Where light comes from, as kernels read it.
#pragma once

#include "razor/frame/line.h"

namespace razor {

/// The dimensions of sample points, a number each, so that no two of a pixel and sample go together.
enum SampleDimension : std::int32_t {
    dimension_film = 1,
    dimension_light = 2, // of the scene's first light
    dimension_sky = 3,
    dimension_lens = 4,
    dimension_count = 5,
    dimension_lobe = -1,   // where a bounce goes within its lobe ...
    dimension_choice = -2, // ... and which lobe it takes
    dimension_emitters = -3,
    dimension_which_light = -4,
    dimension_chosen_light = -5
};
/// Of the scene's light of that number, whether or not those before it have radiance.
constexpr std::int32_t light_dimension(int light) {
    return light == 0 ? dimension_light : dimension_count - 1 + light;
}

/// How a light's points are sampled (razor/kernels/light_samples.h).
enum LightShape : std::int32_t {
    light_rectangle,
    light_disk,
    light_sphere,
    light_point, // and spots
    light_directional
};

/// Lights without radiance have no record. What members mean depends on the shape, in this order: rectangle;
/// disk; sphere; point; directional.
struct alignas(line_bytes) LightRecord {
    float corner[3];            // scene coordinates; of others than rectangles the middle
    float edge_u[3], edge_v[3]; // of a disk radii at right angles
    float normal[3];            // unit; to where a disk emits, of a spot its axis, towards directional light
    /// Each / (pi x samples): radiance x area; x area; x 2 pi; intensity; irradiance x 2 / (1 + cos of the
    /// angular radius).
    float radiance[3];
    float spacing;              // of the samples that a pixel takes: see growth_to_area(), times edge_pixels
    std::int32_t samples;       // shadow rays a hit
    std::int32_t dimension;     // of its sample points (razor/kernels/sampling.h)
    std::int32_t shape;         // a LightShape
    float radius;               // of a sphere
    float versine;              // 1 - cos of a directional light's angular radius
    float cone_end, cone_scale; // of a spot: 1 - cos where it ends, 1 / (that - where it is whole)
    float emitted[3];           // radiance; 0 of a point
    /// Where the density of samples, by solid angle, is the cosine to the normal of what is lit, over this
    /// and their weight; 0 of what no ray meets by chance.
    float domain;
    std::int32_t padding[5];
};
static_assert(sizeof(LightRecord) == 2 * line_bytes);

} // namespace razor
