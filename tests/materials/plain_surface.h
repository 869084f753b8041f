// The surfaces of razor/scene/material.h again, in double and by their definitions: what they reflect from
// one direction into another, and what of light from everywhere. Nothing here is shared with the kernels.
#pragma once

#include "razor/scene/material.h"

#include <glm/vec3.hpp>

namespace razor::test {

/// z is the normal; all directions point away from the surface; the viewer is above.
class PlainSurface {
public:
    /// `inside`: the viewer is within what it lets light into.
    explicit PlainSurface(const Material& material, bool inside = false)
        : m_(material), inside_(inside && let_through() > 0) {}

    /// The value of the reflectance, 1 / steradian; `light.z` > 0: of what goes in all directions, which are
    /// diffuse reflection and sheen, of rough lobes, and of both.
    glm::dvec3 scattered(const glm::dvec3& view, const glm::dvec3& light) const;
    glm::dvec3 rough(const glm::dvec3& view, const glm::dvec3& light) const;
    glm::dvec3 reflectance(const glm::dvec3& view, const glm::dvec3& light) const {
        return scattered(view, light) + rough(view, light);
    }

    /// Of light of radiance 1 from everywhere, what is seen: of reflection, and of what comes through from
    /// below, each lobe by an integral over normals (n x n points).
    glm::dvec3 reflected(const glm::dvec3& view, int n) const;
    glm::dvec3 transmitted(const glm::dvec3& view, int n) const;

    /// Of light that goes through at normals h of density D cos, what is seen for each, and where it comes
    /// from, below; nothing where all is reflected. A mirror's h is z.
    glm::dvec3 through(const glm::dvec3& view, const glm::dvec3& h, glm::dvec3& light) const;
    /// Of what is not reflected, what goes through.
    double let_through() const { return (1 - double(m_.metallic)) * m_.transmission; }

    /// Schlick's factor for light from outside.
    static double schlick(double cosine);
    /// Of the base, from the viewer's side.
    glm::dvec3 base_fresnel(double cosine) const;
    double coat_fresnel(double cosine) const;
    /// Of all that is below the sheen, what this leaves.
    double below_sheen(double cos_view, double cos_light) const;

private:
    /// Schlick's factor from the viewer's side, which takes the cosine on the thinner side.
    double graze(double cosine) const;
    double dielectric(double cosine) const;
    /// Of diffuse reflection, below a dielectric.
    double below(double view, double light) const;

    Material m_;
    bool inside_;
};

} // namespace razor::test
