#include "tests/reference/intersect.h"

#include <cmath>

namespace razor::reference {

namespace {

/// p x q; where it is zero, a sign that belongs to the origin's passing at (e, e^2).
double edge_function(const glm::dvec3& p, const glm::dvec3& q, int& sign) {
    double a = p.x * q.y;
    double b = p.y * q.x;
    double d = a - b;
    if (a == b)
        d = std::fma(p.x, q.y, -a) - std::fma(p.y, q.x, -b);
    // (p - (e, e^2)) x (q - (e, e^2)) = p x q + e (p.y - q.y) + e^2 (q.x - p.x)
    double decides = d != 0 ? d : p.y != q.y ? p.y - q.y : q.x - p.x;
    sign = (decides > 0) - (decides < 0);
    return d;
}

} // namespace

RayFrame::RayFrame(const Ray& ray) {
    const glm::dvec3& d = ray.direction;
    kz_ = std::abs(d.y) > std::abs(d.x) ? 1 : 0;
    if (std::abs(d.z) > std::abs(d[kz_]))
        kz_ = 2;
    kx_ = (kz_ + 1) % 3;
    ky_ = (kx_ + 1) % 3;
    scale_ = 1 / d[kz_];
    shear_x_ = d[kx_] * scale_;
    shear_y_ = d[ky_] * scale_;
    origin_ = {ray.origin[kx_], ray.origin[ky_], ray.origin[kz_]};
}

glm::dvec3 RayFrame::shear(const glm::dvec3& p) const {
    double z = p[kz_] - origin_.z;
    return {p[kx_] - origin_.x - shear_x_ * z, p[ky_] - origin_.y - shear_y_ * z, z};
}

bool RayFrame::cross(const std::array<glm::dvec3, 3>& p, bool sliver, Crossing& crossing) const {
    int sign[3];
    double u = edge_function(p[1], p[2], sign[0]);
    double v = edge_function(p[2], p[0], sign[1]);
    double w = edge_function(p[0], p[1], sign[2]);
    if (sign[0] == 0 || sign[0] != sign[1] || sign[0] != sign[2])
        return false;
    double sum = u + v + w;
    if (sliver || sum == 0) {
        // Nearly collinear, so that areas are noise: on its longest side, by that side's longer extent.
        std::size_t side = 0;
        int axis = 0;
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            for (int x = 0; x < 2; ++x) {
                double extent = std::abs(p[(k + 2) % 3][x] - p[(k + 1) % 3][x]);
                if (extent > longest) {
                    longest = extent;
                    side = k;
                    axis = x;
                }
            }
        std::size_t first = (side + 1) % 3;
        std::size_t last = (side + 2) % 3;
        double begin = p[first][axis];
        double end = p[last][axis];
        double place = begin == end ? 0 : std::min(std::max(begin / (begin - end), 0.0), 1.0);
        crossing.t = t(p[first].z + place * (p[last].z - p[first].z));
        double weight[3]{};
        weight[first] = 1 - place;
        weight[last] = place;
        crossing.along[0] = weight[1];
        crossing.along[1] = weight[2];
        return true;
    }
    crossing.t = t((u * p[0].z + v * p[1].z + w * p[2].z) / sum);
    crossing.along[0] = v / sum;
    crossing.along[1] = w / sum;
    return true;
}

std::vector<Crossing> crossings(const Ray& ray, const Soup& soup) {
    RayFrame frame(ray);
    std::vector<glm::dvec3> sheared;
    sheared.reserve(soup.points.size());
    for (const glm::dvec3& p : soup.points)
        sheared.push_back(frame.shear(p));
    std::vector<Crossing> found;
    for (std::size_t n = 0; n < soup.triangles.size(); ++n) {
        const Triangle& t = soup.triangles[n];
        std::array<glm::dvec3, 3> p;
        for (std::size_t k = 0; k < 3; ++k)
            p[k] = sheared[static_cast<std::size_t>(t.points[k])];
        // Most triangles are clear of the ray.
        if ((p[0].x > 0 && p[1].x > 0 && p[2].x > 0) || (p[0].x < 0 && p[1].x < 0 && p[2].x < 0) ||
            (p[0].y > 0 && p[1].y > 0 && p[2].y > 0) || (p[0].y < 0 && p[1].y < 0 && p[2].y < 0))
            continue;
        Crossing c;
        if (frame.cross(p, t.sliver, c)) {
            c.triangle = static_cast<int>(n);
            found.push_back(c);
        }
    }
    return found;
}

Hits hits(const Ray& ray, const Soup& soup) {
    Hits result;
    for (const Crossing& c : crossings(ray, soup)) {
        if (!(c.t > 0))
            continue;
        ++result.count;
        if (result.nearest.triangle < 0 || c.t < result.nearest.t)
            result.nearest = c;
    }
    return result;
}

} // namespace razor::reference
