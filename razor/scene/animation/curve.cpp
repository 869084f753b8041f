#include "razor/scene/animation/curve.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <iterator>

namespace razor {
namespace {

glm::dquat to_quaternion(const double* xyzw) {
    return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

void store(const glm::dquat& q, std::span<double> xyzw) {
    xyzw[0] = q.x, xyzw[1] = q.y, xyzw[2] = q.z, xyzw[3] = q.w;
}

} // namespace

void Curve::at(double seconds, std::span<double> result) const {
    const bool cubic = kind == CurveKind::cubic_spline;
    const auto value = [&](std::size_t key) { return values.data() + (cubic ? 3 * key + 1 : key) * width; };
    const auto after = static_cast<std::size_t>(
        std::distance(times.begin(), std::upper_bound(times.begin(), times.end(), seconds)));
    if (after == 0 || after == times.size() || kind == CurveKind::step) {
        const double* const held = value(after == 0 ? 0 : after - 1);
        std::copy(held, held + width, result.begin());
    } else {
        const std::size_t before = after - 1;
        const double length = times[after] - times[before], x = (seconds - times[before]) / length;
        const double *const a = value(before), *const b = value(after);
        if (cubic) {
            const double *const out_of_a = a + width, *const into_b = b - width;
            const double y = 1 - x;
            for (std::size_t i = 0; i < width; ++i)
                result[i] = y * y * (1 + 2 * x) * a[i] + x * x * (1 + 2 * y) * b[i] +
                            length * x * y * (y * out_of_a[i] - x * into_b[i]);
        } else if (rotation) {
            const glm::dquat from = glm::normalize(to_quaternion(a)), to = glm::normalize(to_quaternion(b));
            store(glm::slerp(from, to, x), result); // turns `to` round where that is shorter
        } else {
            for (std::size_t i = 0; i < width; ++i)
                result[i] = a[i] + (b[i] - a[i]) * x;
        }
    }
    if (rotation)
        store(glm::normalize(to_quaternion(result.data())), result);
}

} // namespace razor
