#include "tests/materials/plain_surface.h"

#include "tests/materials/plain_sheen.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace razor::test {
namespace {

using glm::dvec3;
using std::numbers::pi;

double distribution(const dvec3& h, double alpha) {
    const double tan_square = (h.x * h.x + h.y * h.y) / (h.z * h.z);
    const double t = 1 + tan_square / (alpha * alpha);
    return 1 / (pi * alpha * alpha * std::pow(h.z, 4) * t * t);
}

/// Smith's auxiliary function.
double lambda(const dvec3& w, double alpha) {
    const double tan_square = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return (std::sqrt(1 + alpha * alpha * tan_square) - 1) / 2;
}

double shadowing(const dvec3& v, const dvec3& l, double alpha) {
    return 1 / (1 + lambda(v, alpha) + lambda(l, alpha));
}

/// The mean over normals of density D cos, of `weight(h)`; a mirror's is that of the one normal.
template <class Weight> dvec3 over_normals(double alpha, int n, Weight weight) {
    if (alpha < 1e-3)
        return weight(dvec3(0, 0, 1));
    dvec3 sum(0);
    for (int i = 0; i < n; ++i) {
        const double x = (i + 0.5) / n;
        const double tan = alpha * std::sqrt(x / (1 - x));
        const double z = 1 / std::sqrt(1 + tan * tan);
        for (int j = 0; j < n; ++j) {
            const double phi = 2 * pi * (j + 0.5) / n;
            sum += weight(dvec3(tan * z * std::cos(phi), tan * z * std::sin(phi), z));
        }
    }
    return sum / double(n * n);
}

/// What a lobe reflects of light from everywhere.
template <class Fresnel> dvec3 lobe(const dvec3& v, double alpha, int n, Fresnel fresnel) {
    return over_normals(alpha, n, [&](const dvec3& h) {
        const double along = glm::dot(v, h);
        const dvec3 l = 2 * along * h - v;
        if (along <= 0 || l.z <= 0)
            return dvec3(0);
        const double weight = alpha < 1e-3 ? 1 : shadowing(v, l, alpha) * along / (v.z * h.z);
        return dvec3(fresnel(along, l.z)) * weight;
    });
}

} // namespace

double PlainSurface::schlick(double cosine) {
    return std::pow(1 - std::min(cosine, 1.0), 5);
}
double PlainSurface::graze(double cosine) const {
    if (!inside_)
        return schlick(cosine);
    const double sine = m_.ior * std::sqrt(std::max(1 - cosine * cosine, 0.0)); // outside
    return sine >= 1 ? 1 : schlick(std::sqrt(1 - sine * sine));
}
double PlainSurface::dielectric(double cosine) const {
    const double f0 = std::pow((m_.ior - 1.0) / (m_.ior + 1.0), 2);
    return m_.specular * (f0 + (1 - f0) * graze(cosine));
}
double PlainSurface::below(double view, double light) const {
    const double f0 = std::pow((m_.ior - 1.0) / (m_.ior + 1.0), 2);
    const auto part = [](double c) { return 1 - std::pow(1 - c / 2, 5); };
    return 1 - m_.specular + m_.specular * 28.0 / 23 * (1 - f0) * part(view) * part(light);
}
dvec3 PlainSurface::base_fresnel(double cosine) const {
    const dvec3 albedo(m_.albedo);
    const dvec3 metal = albedo + (dvec3(1) - albedo) * graze(cosine);
    return double(m_.metallic) * metal + dvec3((1 - double(m_.metallic)) * dielectric(cosine));
}
double PlainSurface::coat_fresnel(double cosine) const {
    return m_.coat * (0.04 + 0.96 * schlick(cosine));
}

double PlainSurface::below_sheen(double view, double light) const {
    const double strength = std::max({m_.sheen.x, m_.sheen.y, m_.sheen.z});
    return strength > 0 ? 1 - strength * plain_sheen(m_.sheen_roughness).taken(view, light) : 1;
}

dvec3 PlainSurface::scattered(const dvec3& v, const dvec3& l) const {
    const double beneath = 1 - coat_fresnel(v.z);
    const dvec3 diffuse = dvec3(m_.albedo) * ((1 - double(m_.metallic)) * (1 - double(m_.transmission)) / pi);
    const dvec3 base = diffuse * below(v.z, l.z) * below_sheen(v.z, l.z);
    if (!has_sheen(m_))
        return beneath * base;
    return beneath * (base + dvec3(m_.sheen) * plain_sheen(m_.sheen_roughness).reflectance(v, l));
}

dvec3 PlainSurface::rough(const dvec3& v, const dvec3& l) const {
    const dvec3 h = glm::normalize(v + l);
    const double along = glm::dot(v, h);
    const auto rough = [&](double roughness) {
        const double alpha = roughness * roughness;
        return alpha < 1e-3 ? 0 : distribution(h, alpha) * shadowing(v, l, alpha) / (4 * v.z * l.z);
    };
    const double beneath = (1 - coat_fresnel(v.z)) * below_sheen(v.z, l.z);
    return beneath * base_fresnel(along) * rough(m_.roughness) +
           dvec3(coat_fresnel(along) * rough(m_.coat_roughness));
}

dvec3 PlainSurface::reflected(const dvec3& v, int n) const {
    const double beneath = 1 - coat_fresnel(v.z);
    // Diffuse: directions of density cos / pi.
    dvec3 diffuse(0);
    for (int i = 0; i < n; ++i) {
        const double light = std::sqrt((i + 0.5) / n);
        diffuse += dvec3(below(v.z, light) * below_sheen(v.z, light) / n);
    }
    diffuse *= dvec3(m_.albedo) * ((1 - double(m_.metallic)) * (1 - double(m_.transmission)));
    const double alpha = double(m_.roughness) * m_.roughness;
    const double coat_alpha = double(m_.coat_roughness) * m_.coat_roughness;
    const dvec3 fibres =
        has_sheen(m_) ? dvec3(m_.sheen) * plain_sheen(m_.sheen_roughness).reflected(v.z) : dvec3(0);
    const auto base = [&](double c, double light) { return base_fresnel(c) * below_sheen(v.z, light); };
    return beneath * (diffuse + fibres + lobe(v, alpha, n, base)) +
           lobe(v, coat_alpha, n, [this](double c, double) { return coat_fresnel(c); });
}

dvec3 PlainSurface::through(const dvec3& v, const dvec3& h, dvec3& l) const {
    const double alpha = double(m_.roughness) * m_.roughness;
    const double eta = inside_ ? double(m_.ior) : 1 / double(m_.ior), along = glm::dot(v, h);
    const double sine_square = eta * eta * (1 - along * along);
    if (along <= 0 || sine_square >= 1)
        return dvec3(0);
    l = (eta * along - std::sqrt(1 - sine_square)) * h - eta * v;
    if (l.z >= 0)
        return dvec3(0);
    const double weight = alpha < 1e-3 ? 1 : shadowing(v, l, alpha) * along / (v.z * h.z);
    // Radiance is as much larger as the cone that it comes from is narrower.
    return dvec3(m_.albedo) * (let_through() * weight * (1 - dielectric(along)) * eta * eta *
                               below_sheen(v.z, -l.z) * (1 - coat_fresnel(v.z)));
}

dvec3 PlainSurface::transmitted(const dvec3& v, int n) const {
    return over_normals(double(m_.roughness) * m_.roughness, n, [&](const dvec3& h) {
        dvec3 l;
        return through(v, h, l);
    });
}

} // namespace razor::test
