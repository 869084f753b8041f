#include "razor/frame/material_records.h"

#include <algorithm>

namespace razor {

MaterialRecord material_record(const Material& m) {
    MaterialRecord r{};
    for (int k = 0; k < 3; ++k) {
        r.albedo[k] = m.albedo[k];
        r.emission[k] = m.emission[k];
    }
    r.metallic = m.metallic;
    r.roughness = m.roughness;
    r.specular = m.specular;
    const float bend = (m.ior - 1) / (m.ior + 1);
    r.normal_reflection = bend * bend;
    r.ior = m.ior;
    r.transmission = m.transmission;
    r.coat = m.coat;
    r.coat_roughness = m.coat_roughness;
    return r;
}

Look look_of(const Scene& scene) {
    const auto plain = [](const Material& m) { return is_matte(m) && m.emission == glm::vec3(0); };
    return scene.settings.diffuse_bounces == 0 &&
                   std::all_of(scene.materials.begin(), scene.materials.end(), plain)
               ? look_matte
               : look_glossy;
}

} // namespace razor
