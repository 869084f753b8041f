#include "tests/materials/plain_sheen.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace razor::test {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr int places = 200;

double mix(double at_1, double at_0, double alpha) {
    const double t = (1 - alpha) * (1 - alpha);
    return at_1 + t * (at_0 - at_1);
}

} // namespace

PlainSheen::PlainSheen(double roughness) : alpha_(std::pow(std::max(roughness, 0.1), 2)) {
    for (int k = 0; k <= places; ++k) {
        const double cosine = std::max(std::pow(double(k) / places, 2), 1e-4);
        albedos_.push_back(
            integral(cosine, [this](const dvec3& v, const dvec3& l) { return defined(v, l); }));
    }
}

template <class Value> double PlainSheen::integral(double cos_view, Value value) const {
    constexpr int heights = 160, turns = 60;
    const dvec3 v(std::sqrt(1 - cos_view * cos_view), 0, cos_view);
    double sum = 0;
    for (int i = 0; i < heights; ++i) {
        const double root = (i + 0.5) / heights, z = root * root, s = std::sqrt(1 - z * z);
        for (int j = 0; j < turns; ++j) {
            const double phi = pi * (j + 0.5) / turns;
            sum += value(v, dvec3(s * std::cos(phi), s * std::sin(phi), z)) * z * 2 * root;
        }
    }
    return sum * 2 * pi / (heights * turns);
}

double PlainSheen::lambda(double cosine) const {
    const double a = mix(21.5473, 25.3245, alpha_), b = mix(3.82987, 3.32435, alpha_),
                 c = mix(0.19823, 0.16801, alpha_), d = mix(-1.97760, -1.27393, alpha_),
                 e = mix(-4.32054, -4.85967, alpha_);
    const auto l = [&](double x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
    return cosine < 0.5 ? std::exp(l(cosine)) : std::exp(2 * l(0.5) - l(1 - cosine));
}

double PlainSheen::defined(const dvec3& v, const dvec3& l) const {
    const dvec3 h = glm::normalize(v + l);
    const double sine = std::sqrt(std::max(1 - h.z * h.z, 0.0));
    const double d = (2 + 1 / alpha_) * std::pow(sine, 1 / alpha_) / (2 * pi);
    return d / ((1 + lambda(v.z) + lambda(l.z)) * 4 * v.z * l.z);
}

double PlainSheen::albedo(double cosine) const {
    const double place = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * places;
    const auto k = std::min(static_cast<std::size_t>(place), std::size_t{places - 1});
    return albedos_[k] + (place - double(k)) * (albedos_[k + 1] - albedos_[k]);
}

double PlainSheen::reflectance(const dvec3& v, const dvec3& l) const {
    return defined(v, l) / std::max({1.0, albedo(v.z), albedo(l.z)});
}

double PlainSheen::reflected(double cos_view) const {
    return integral(cos_view, [this](const dvec3& v, const dvec3& l) { return reflectance(v, l); });
}

double PlainSheen::taken(double cos_view, double cos_light) const {
    return std::min(std::max(albedo(cos_view), albedo(cos_light)), 1.0);
}

const PlainSheen& plain_sheen(double roughness) {
    static std::map<double, PlainSheen> known;
    const auto found = known.find(roughness);
    return found != known.end() ? found->second
                                : known.emplace(roughness, PlainSheen(roughness)).first->second;
}

} // namespace razor::test
