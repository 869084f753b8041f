#include "razor/frame/sheen_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace razor {
namespace {

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

} // namespace

std::vector<float> sheen_albedo(double alpha) {
    using std::numbers::pi;
    constexpr int heights = 192, turns = 96;
    const Lambda lambda(alpha);
    std::array<double, heights> cosine{}, of_light{};
    for (std::size_t i = 0; i < heights; ++i) {
        const double x = (static_cast<double>(i) + 0.5) / heights;
        cosine[i] = x * x; // finer at grazing angles
        of_light[i] = lambda(cosine[i]);
    }
    std::vector<float> albedo;
    for (int k = 0; k < sheen_steps; ++k) {
        const double place = static_cast<double>(k) / (sheen_steps - 1);
        const double view = std::max(place * place, double{least_sheen_cosine});
        const double sine = std::sqrt(1 - view * view), of_view = lambda(view);
        double sum = 0;
        for (std::size_t i = 0; i < heights; ++i) {
            const double sine_light = std::sqrt(1 - cosine[i] * cosine[i]);
            double ring = 0;
            for (int j = 0; j < turns; ++j) {
                const double phi = pi * (j + 0.5) / turns;
                const double x = sine + sine_light * std::cos(phi), y = sine_light * std::sin(phi),
                             z = view + cosine[i];
                const double across = (x * x + y * y) / (x * x + y * y + z * z);
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

} // namespace razor
