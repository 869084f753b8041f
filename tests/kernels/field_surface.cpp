#include "tests/kernels/field_surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace razor::test {
namespace {

glm::dvec3 vec(const Point& p) {
    return {p[0], p[1], p[2]};
}
glm::dvec3 vec(const float* p) {
    return {p[0], p[1], p[2]};
}

/// How often 2 divides i > 0.
int twos(int i) {
    return std::countr_zero(static_cast<unsigned>(i));
}

/// Of a vertex born at absolute level `birth` (Design: rule 2; the last quarter of an octave).
double weight(double target, int birth) {
    const double gone = std::ldexp(1.0, birth + 1);
    const double x = std::clamp((target / gone - 0.875) * 8, 0.0, 1.0);
    return 1 - x * x * (3 - 2 * x);
}

} // namespace

FieldSurface::FieldSurface(Frame& frame) : origins_(instance_origins(frame)) {
    const FrameHeader& h = frame.header();
    for (int patch = 0; patch < h.patch_count; ++patch) {
        const std::vector<BlockView> blocks = blocks_of(frame, patch);
        if (blocks.empty())
            continue; // an unused number
        const PatchRecord& record = patch_record(frame, patch);
        const BlockHeader& first = *blocks.front().header;
        Grid g;
        g.instance = first.instance;
        g.first_level = h.instances.get()[first.instance].first_level;
        g.triangles = first.triangles;
        g.nu = first.exponent[0];
        g.nv = first.exponent[1];
        g.part = record.kind < PatchKind::flat_quad && (record.side_flags[0] & side_half) != 0;
        const int width = (1 << g.nu) + 1;
        g.anchors.resize(static_cast<std::size_t>(width) * ((1U << g.nv) + 1));
        for (const BlockView& b : blocks) {
            for (int s = 0; s < 4; ++s)
                if (b.header->curve[s] != inner_side) {
                    const bool half = (record.side_flags[s] & side_half) != 0 && record.side_curve[s] >= 0;
                    g.side[s] = {b.header->curve[s], (s % 2 == 0 ? g.nu : g.nv) + (half ? 1 : 0)};
                }
            for (int i = 0; i < b.header->stride; ++i) {
                const int u = b.header->column * block_quads + i % (b.header->quads_u + 1);
                const int v = b.header->row * block_quads + i / (b.header->quads_u + 1);
                g.anchors[static_cast<std::size_t>(v * width + u)] = vec(b.vertex(i));
            }
        }
        if (g.part) {
            const BlockView root = block_at(frame, h.trees.get()[0].patches.get()[patch].root);
            g.middle[0] = vec(root.words + root.header->middles + ends_mean);
            g.middle[1] = vec(root.words + root.header->middles + ends_mean + 3);
        }
        grids_.push_back(std::move(g));
    }
}

FieldSurface::Seen FieldSurface::see(const Grid& g, const Ray& ray) const {
    const glm::dvec3 from = vec(ray.origin) - vec(origins_[static_cast<std::size_t>(g.instance)]);
    const int across = 1 << g.nu, up = 1 << g.nv, width = across + 1;
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(j * width + i); };
    Seen seen{g.anchors, 0};
    const auto blend = [&](int i, int j, int birth, const glm::dvec3& mean) {
        const glm::dvec3& anchor = g.anchors[at(i, j)];
        const glm::dvec3 way = anchor - from;
        const double blur = std::abs(ray.base + glm::dot(vec(ray.slope), way));
        const double w = weight(blur + ray.growth * glm::length(way), birth);
        seen.between += w > 0 && w < 1 ? 1 : 0;
        seen.points[at(i, j)] = w * anchor + (1 - w) * mean;
    };
    if (g.part) {
        if (g.side[0].curve >= 0)
            blend(across, 0, g.first_level + g.side[0].curve - 1, g.middle[0]);
        if (g.side[3].curve >= 0)
            blend(0, up, g.first_level + g.side[3].curve - 1, g.middle[1]);
    }
    for (int step = std::max(across, up) / 2; step >= 1; step /= 2)
        for (int j = 0; j <= up; ++j)
            for (int i = 0; i <= across; ++i) {
                const bool end_u = i == 0 || i == across, end_v = j == 0 || j == up;
                if (end_u && end_v)
                    continue;
                const bool odd_u = !end_u && twos(i) == twos(step);
                const bool odd_v = !end_v && twos(j) == twos(step);
                if ((!odd_u && !odd_v) || (!end_u && twos(i) < twos(step)) ||
                    (!end_v && twos(j) < twos(step)))
                    continue;
                const int di = odd_u ? step : 0, dj = odd_v ? step : 0;
                const glm::dvec3 mean =
                    0.5 * (seen.points[at(i - di, j - dj)] + seen.points[at(i + di, j + dj)]);
                int birth = g.first_level + twos(step);
                if (end_u || end_v) {
                    const Side& side = g.side[j == 0 ? 0 : j == up ? 2 : i == across ? 1 : 3];
                    if (side.curve == straight_curve)
                        continue; // at its anchor
                    birth += side.curve - side.exponent;
                    if (birth < g.first_level) { // hangs
                        seen.points[at(i, j)] = mean;
                        continue;
                    }
                }
                blend(i, j, birth, mean);
            }
    return seen;
}

std::size_t FieldSurface::vertices() const {
    std::size_t n = 0;
    for (const Grid& g : grids_)
        n += g.anchors.size();
    return n;
}

std::size_t FieldSurface::between(const Ray& ray) const {
    std::size_t n = 0;
    for (const Grid& g : grids_)
        n += see(g, ray).between;
    return n;
}

std::vector<FieldSurface::Crossing> FieldSurface::crossings(const Ray& ray, double widen) const {
    std::vector<Crossing> found;
    const glm::dvec3 d = vec(ray.direction);
    for (const Grid& g : grids_) {
        const Seen seen = see(g, ray);
        const glm::dvec3 from = vec(ray.origin) - vec(origins_[static_cast<std::size_t>(g.instance)]);
        const int across = 1 << g.nu, up = 1 << g.nv, width = across + 1;
        const auto meet = [&](const glm::dvec3& a, const glm::dvec3& b,
                              const glm::dvec3& c) { // Moeller, Trumbore
            const glm::dvec3 e1 = b - a, e2 = c - a, s = from - a;
            const glm::dvec3 p = glm::cross(d, e2), q = glm::cross(s, e1);
            const double det = glm::dot(e1, p);
            if (det == 0)
                return;
            const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det, t = glm::dot(e2, q) / det;
            if (u < -widen || v < -widen || u + v > 1 + widen || t < ray.t_min || t > ray.t_max)
                return;
            const double size = glm::length(e1) + glm::length(e2);
            const double cosine = std::abs(det) / std::max(glm::length(glm::cross(e1, e2)), 1e-300);
            found.push_back({t, (std::abs(widen) * size + 1e-6 * (std::abs(t) + glm::length(from))) /
                                    std::max(cosine, 1e-9)});
        };
        for (int j = 0; j < up; ++j)
            for (int i = 0; i < across; ++i) {
                const auto at = static_cast<std::size_t>(j * width + i);
                const auto next = at + static_cast<std::size_t>(width);
                meet(seen.points[at], seen.points[at + 1], seen.points[next + 1]);
                if (g.triangles > 1)
                    meet(seen.points[at], seen.points[next + 1], seen.points[next]);
            }
    }
    std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
    return found;
}

} // namespace razor::test
