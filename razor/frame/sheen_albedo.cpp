#include "razor/frame/sheen_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace razor {
namespace {

using std::numbers::pi;

constexpr int heights = 192, turns = 96;
constexpr float rows_a_root = 48; // in one unit of the root

/// Estevez & Kulla 2017, table 1: fits of lambda for alpha 0 and 1, between which (1 - alpha)^2 goes.
class Lambda {
public:
    explicit Lambda(double alpha) {
        constexpr std::array<double, 5> at_0{25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
        constexpr std::array<double, 5> at_1{21.5473, 3.82987, 0.19823, -1.97760, -4.32054};
        const double part = (1 - alpha) * (1 - alpha);
        for (std::size_t k = 0; k < at_0.size(); ++k)
            p_[k] = part * at_0[k] + (1 - part) * at_1[k];
    }
    double operator()(double cosine) const {
        return std::exp(cosine < 0.5 ? fit(cosine) : 2 * fit(0.5) - fit(1 - cosine));
    }

private:
    double fit(double x) const { return p_[0] / (1 + p_[1] * std::pow(x, p_[2])) + p_[3] * x + p_[4]; }
    std::array<double, 5> p_{};
};

double cosine_of_step(int k) {
    const double place = static_cast<double>(k) / (sheen_steps - 1);
    return std::max(place * place, double{least_sheen_cosine});
}

/// Of the normal half way to the light, turned away from the viewer by the middle of turn j.
double sine_square(double view, double sine, double light, double sine_light, int j) {
    const double phi = pi * (j + 0.5) / turns;
    const double x = sine + sine_light * std::cos(phi), y = sine_light * std::sin(phi), z = view + light;
    return (x * x + y * y) / (x * x + y * y + z * z);
}

/// sheen_albedo() of many widths, row after row: they share the logarithms, and floats serve for the powers,
/// which else take the time.
std::vector<float> sheen_albedos(const std::vector<double>& alphas) {
    const std::size_t count = alphas.size();
    const std::vector<Lambda> lambda(alphas.begin(), alphas.end());
    std::vector<float> albedos(count * sheen_steps);
    std::array<float, turns> logs{};
    for (std::size_t k = 0; k < sheen_steps; ++k) {
        const double view = cosine_of_step(static_cast<int>(k)), sine = std::sqrt(1 - view * view);
        std::vector<double> sums(count);
        for (int i = 0; i < heights; ++i) {
            const double root = (i + 0.5) / heights, light = root * root; // finer at grazing angles
            const double sine_light = std::sqrt(1 - light * light);
            for (int j = 0; j < turns; ++j)
                logs[static_cast<std::size_t>(j)] =
                    static_cast<float>(std::log(sine_square(view, sine, light, sine_light, j)));
            for (std::size_t n = 0; n < count; ++n) {
                const auto power = static_cast<float>(0.5 / alphas[n]);
                double ring = 0;
                for (const float log : logs)
                    ring += double{std::exp(power * log)};
                sums[n] += ring * root / (1 + lambda[n](view) + lambda[n](light));
            }
        }
        for (std::size_t n = 0; n < count; ++n)
            albedos[n * sheen_steps + k] =
                static_cast<float>(sums[n] * (2 + 1 / alphas[n]) / (2.0 * heights * turns * view));
    }
    return albedos;
}

} // namespace

std::vector<float> sheen_albedo(double alpha) {
    const Lambda lambda(alpha);
    std::array<double, heights> cosine{}, of_light{};
    for (std::size_t i = 0; i < heights; ++i) {
        const double x = (static_cast<double>(i) + 0.5) / heights;
        cosine[i] = x * x; // finer at grazing angles
        of_light[i] = lambda(cosine[i]);
    }
    std::vector<float> albedo;
    for (int k = 0; k < sheen_steps; ++k) {
        const double view = cosine_of_step(k);
        const double sine = std::sqrt(1 - view * view), of_view = lambda(view);
        double sum = 0;
        for (std::size_t i = 0; i < heights; ++i) {
            const double sine_light = std::sqrt(1 - cosine[i] * cosine[i]);
            double ring = 0;
            for (int j = 0; j < turns; ++j) {
                const double across = sine_square(view, sine, cosine[i], sine_light, j);
                ring += std::pow(across, 0.5 / alpha);
            }
            // D V cos over solid angle; the root of the cosine is what is stepped evenly.
            const double step = 2 * std::sqrt(cosine[i]) / heights;
            sum += ring * (2 * pi / turns) * step / (1 + of_view + of_light[i]);
        }
        albedo.push_back(static_cast<float>(sum * (2 + 1 / alpha) / (2 * pi) / (4 * view)));
    }
    return albedo;
}

SheenRows sheen_albedo_rows(float least, float most) {
    SheenRows rows;
    rows.first_root = std::sqrt(least);
    const float range = std::sqrt(most) - rows.first_root;
    rows.last = std::max(static_cast<int>(std::ceil(range * rows_a_root)), 1);
    rows.per_root = range > 0 ? static_cast<float>(rows.last) / range : 0;
    std::vector<double> alphas;
    for (int row = 0; row <= rows.last; ++row)
        alphas.push_back(std::pow(rows.first_root + range * static_cast<double>(row) / rows.last, 4));
    rows.albedo = sheen_albedos(alphas);
    return rows;
}

} // namespace razor
