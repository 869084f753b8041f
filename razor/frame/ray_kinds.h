// The kinds of rays, as statistics and reports name them.
#pragma once

namespace razor {

enum RayKind : int {
    kind_none,   // work that is not the tracing of a ray
    kind_camera, // closest hits
    kind_light,  // shadow rays to lights
    kind_sky,    // shadow rays to the sky
    kind_bounce, // closest hits of what surfaces reflect and let through
    kind_count
};
inline constexpr const char* kind_names[kind_count] = {"none", "camera", "light", "sky", "bounce"};

} // namespace razor
