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

/// Tables of albedos by roughness.
class PlainAlbedo {
public:
    static const std::vector<double>& of(int multiple) {
        static std::map<int, std::vector<double>> known;
        const auto [found, is_new] = known.try_emplace(multiple);
        if (is_new) {
            const PlainSheen sheen(multiple * step);
            for (int k = 0; k <= places; ++k) {
                const double cosine = std::max(std::pow(double(k) / places, 2), 1e-4);
                found->second.push_back(sheen.integral(
                    cosine, [&](const dvec3& v, const dvec3& l) { return sheen.defined(v, l); }));
            }
        }
        return found->second;
    }
    static constexpr double step = 0.025;
};

PlainSheen::PlainSheen(double roughness) : alpha_(std::pow(std::max(roughness, 0.1), 2)) {}

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
    const auto in = [&](const std::vector<double>& table) {
        return table[k] + (place - double(k)) * (table[k + 1] - table[k]);
    };
    const double below = in(*below_);
    return part_ > 0 ? below + part_ * (in(*above_) - below) : below;
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

PlainSheen plain_sheen(double roughness) {
    PlainSheen sheen(roughness);
    const double within = std::clamp(roughness, 0.1, 1.0), place = within / PlainAlbedo::step;
    const int nearest = static_cast<int>(std::lround(place)), low = static_cast<int>(place);
    if (std::abs(place - nearest) < 1e-5) {
        sheen.below_ = &PlainAlbedo::of(nearest);
        return sheen;
    }
    sheen.below_ = &PlainAlbedo::of(low);
    sheen.above_ = &PlainAlbedo::of(low + 1);
    const double root = std::sqrt(low * PlainAlbedo::step), next = std::sqrt((low + 1) * PlainAlbedo::step);
    sheen.part_ = (std::sqrt(within) - root) / (next - root);
    return sheen;
}

} // namespace razor::test
