#include "tests/analysis/plain_flip.h"

#include <algorithm>
#include <cmath>

namespace analysis::plain {
namespace {

constexpr double pi = 3.14159265358979323846;
using Triple = std::array<double, 3>;

// IEC 61966-2-1 with more digits than the standard prints.
constexpr double to_xyz[3][3] = {{0.4123907992659595, 0.357584339383878, 0.1804807884018343},
                                 {0.21263900587151027, 0.715168678767756, 0.07219231536073371},
                                 {0.01933081871559182, 0.11919477979462598, 0.9505321522496607}};
constexpr double white[3] = {0.9504559270516716, 1, 1.0890577507598784};

Triple xyz_of(const Triple& rgb) {
    Triple out{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            out[i] += to_xyz[i][c] * rgb[c] / white[i];
        }
    }
    return out;
}

/// Gaussian elimination without pivots, which this matrix does not need.
Triple rgb_of(const Triple& xyz) {
    double m[3][4];
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            m[i][c] = to_xyz[i][c];
        }
        m[i][3] = xyz[i] * white[i];
    }
    for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t i = 0; i < 3; ++i) {
            const double factor = i == p ? 0 : m[i][p] / m[p][p];
            for (std::size_t c = p; c < 4; ++c) {
                m[i][c] -= factor * m[p][c];
            }
        }
    }
    return {m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]};
}

double f(double t) {
    return t > std::pow(6.0 / 29, 3) ? std::cbrt(t) : 841.0 / 108 * t + 4.0 / 29;
}

Triple hunt_lab(const Triple& rgb) {
    const Triple xyz = xyz_of(rgb);
    const double l = 116 * f(xyz[1]) - 16;
    return {l, l / 100 * 500 * (f(xyz[0]) - f(xyz[1])), l / 100 * 200 * (f(xyz[1]) - f(xyz[2]))};
}

double distance(const Triple& a, const Triple& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

using Planes = std::array<std::vector<double>, 3>;

Planes opponent(const LinearImage& image) {
    Planes out;
    for (std::size_t i = 0; i < image.size(); ++i) {
        Triple rgb{};
        for (std::size_t c = 0; c < 3; ++c) {
            rgb[c] = std::clamp(double{image.planes[c][i]}, 0.0, 1.0);
        }
        const Triple xyz = xyz_of(rgb);
        out[0].push_back(116 * xyz[1] - 16);
        out[1].push_back(500 * (xyz[0] - xyz[1]));
        out[2].push_back(200 * (xyz[1] - xyz[2]));
    }
    return out;
}

std::vector<Triple> perceived(const Planes& planes, const LinearImage& size, double ppd) {
    const std::vector<double> y = convolve(planes[0], size.width, size.height, sensitivity_kernel('A', ppd));
    const std::vector<double> cx = convolve(planes[1], size.width, size.height, sensitivity_kernel('R', ppd));
    const std::vector<double> cz = convolve(planes[2], size.width, size.height, sensitivity_kernel('B', ppd));
    std::vector<Triple> out;
    for (std::size_t i = 0; i < y.size(); ++i) {
        const double luminance = (y[i] + 16) / 116;
        Triple rgb = rgb_of({cx[i] / 500 + luminance, luminance, luminance - cz[i] / 200});
        for (double& value : rgb) {
            value = std::clamp(value, 0.0, 1.0);
        }
        out.push_back(hunt_lab(rgb));
    }
    return out;
}

std::vector<double> feature(const Planes& planes, const LinearImage& size, int order, double ppd) {
    std::vector<double> y = planes[0];
    for (double& value : y) {
        value = (value + 16) / 116;
    }
    std::vector<double> across = convolve(y, size.width, size.height, feature_kernel(order, false, ppd));
    const std::vector<double> down = convolve(y, size.width, size.height, feature_kernel(order, true, ppd));
    for (std::size_t i = 0; i < across.size(); ++i) {
        across[i] = std::hypot(across[i], down[i]);
    }
    return across;
}

Kernel square(int radius, const auto& weight) {
    Kernel out{radius, radius, {}};
    for (int y = -radius; y <= radius; ++y) {
        for (int x = -radius; x <= radius; ++x) {
            out.weights.push_back(weight(x, y));
        }
    }
    return out;
}

} // namespace

Kernel sensitivity_kernel(char channel, double ppd) {
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    const auto gaussian = [&](double a, double b, int x, int y) {
        return a * std::sqrt(pi / b) * std::exp(-pi * pi * (x * x + y * y) / (ppd * ppd) / b);
    };
    Kernel out = square(radius, [&](int x, int y) {
        return channel == 'A'   ? gaussian(1, 0.0047, x, y)
               : channel == 'R' ? gaussian(1, 0.0053, x, y)
                                : gaussian(34.1, 0.04, x, y) + gaussian(13.5, 0.025, x, y);
    });
    double sum = 0;
    for (const double weight : out.weights) {
        sum += weight;
    }
    for (double& weight : out.weights) {
        weight /= sum;
    }
    return out;
}

Kernel feature_kernel(int order, bool down, double ppd) {
    const double sigma = 0.082 / 2 * ppd;
    Kernel out = square(static_cast<int>(std::ceil(3 * sigma)), [&](int x, int y) {
        const double across = down ? y : x;
        const double gaussian = std::exp(-(x * x + y * y) / (2 * sigma * sigma));
        return (order == 1 ? -across : across * across / (sigma * sigma) - 1) * gaussian;
    });
    double positive = 0, negative = 0;
    for (const double weight : out.weights) {
        (weight > 0 ? positive : negative) += std::abs(weight);
    }
    for (double& weight : out.weights) {
        weight /= weight > 0 ? positive : negative;
    }
    return out;
}

std::vector<double> convolve(const std::vector<double>& plane, int width, int height, const Kernel& kernel) {
    std::vector<double> out;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            double sum = 0;
            auto weight = kernel.weights.begin();
            for (int j = -kernel.radius_y; j <= kernel.radius_y; ++j) {
                for (int i = -kernel.radius_x; i <= kernel.radius_x; ++i) {
                    const int from_x = std::clamp(x + i, 0, width - 1),
                              from_y = std::clamp(y + j, 0, height - 1);
                    sum += *weight++ * plane[static_cast<std::size_t>(from_y * width + from_x)];
                }
            }
            out.push_back(sum);
        }
    }
    return out;
}

std::vector<double> ldr_flip(const LinearImage& a, const LinearImage& b, double ppd) {
    const Planes opponent_a = opponent(a), opponent_b = opponent(b);
    const std::vector<Triple> lab_a = perceived(opponent_a, a, ppd), lab_b = perceived(opponent_b, b, ppd);
    const std::vector<double> edge_a = feature(opponent_a, a, 1, ppd),
                              edge_b = feature(opponent_b, b, 1, ppd);
    const std::vector<double> point_a = feature(opponent_a, a, 2, ppd),
                              point_b = feature(opponent_b, b, 2, ppd);
    const double largest = std::pow(distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
    std::vector<double> out;
    for (std::size_t i = 0; i < lab_a.size(); ++i) {
        const double error = std::pow(distance(lab_a[i], lab_b[i]), 0.7);
        const double colour = error < 0.4 * largest ? 0.95 / (0.4 * largest) * error
                                                    : 0.95 + 0.05 * (error - 0.4 * largest) / (0.6 * largest);
        const double features =
            std::max(std::abs(edge_a[i] - edge_b[i]), std::abs(point_a[i] - point_b[i])) / std::sqrt(2.0);
        out.push_back(std::pow(colour, 1 - std::sqrt(features)));
    }
    return out;
}

std::vector<double> hdr_flip(const LinearImage& a, const LinearImage& b, double ppd,
                             const std::vector<double>& exposures) {
    std::vector<double> out(a.size());
    for (const double exposure : exposures) {
        const auto shown = [&](LinearImage image) {
            for (auto& plane : image.planes) {
                for (float& value : plane) {
                    const double x = 0.6 * std::pow(2.0, exposure) * std::max(double{value}, 0.0);
                    value = static_cast<float>(
                        std::min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1.0));
                }
            }
            return image;
        };
        const std::vector<double> error = ldr_flip(shown(a), shown(b), ppd);
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = std::max(out[i], error[i]);
        }
    }
    return out;
}

} // namespace analysis::plain
