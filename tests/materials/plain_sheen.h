// Sheen in double precision, by its definition: Estevez & Kulla, Production Friendly Microfacet Sheen BRDF,
// 2017. Nothing here is shared with the renderer.
#pragma once

#include <glm/vec3.hpp>

#include <vector>

namespace razor::test {

/// A lobe of one roughness and the colour 1. z is the normal; directions point away from the surface.
class PlainSheen {
public:
    /// 1 / steradian. Never gives back more than it gets: where the definition does, it is divided by the
    /// larger of both directions' albedos.
    double reflectance(const glm::dvec3& view, const glm::dvec3& light) const;
    /// Of light of radiance 1 from everywhere.
    double reflected(double cos_view) const;
    /// The larger of both directions' albedos, at most 1: what all below does not have.
    double taken(double cos_view, double cos_light) const;

private:
    friend PlainSheen plain_sheen(double roughness);
    friend class PlainAlbedo;
    explicit PlainSheen(double roughness);

    double defined(const glm::dvec3& view, const glm::dvec3& light) const;
    double lambda(double cosine) const;
    double albedo(double cosine) const;
    template <class Value> double integral(double cos_view, Value value) const;

    double alpha_;
    /// Of the roughnesses beside it, between places that are evenly spaced in the root of the cosine; `part_`
    /// of the second.
    const std::vector<double>*below_ = nullptr, *above_ = nullptr;
    double part_ = 0;
};

/// That of any roughness. Albedos are by the definition for whole multiples of 0.025, made once, and straight
/// over the root of the roughness between these.
PlainSheen plain_sheen(double roughness);

} // namespace razor::test
