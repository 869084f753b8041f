#include "razor/check/field_surface.h"

#include "razor/frame/transition.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace razor::check {
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

/// Of a vertex born at absolute level `birth` (Design: rule 2).
double weight(double target, int birth) {
    const double gone = std::ldexp(1.0, birth + 1);
    const double part = target * level_rounding / gone;
    const double x = std::clamp((part - morph_begin) / (1 - morph_begin), 0.0, 1.0);
    return 1 - x * x * (3 - 2 * x);
}

constexpr int tile_quads = 8;

/// The inverse of a direction; components that are zero give the largest number, not infinity.
glm::dvec3 inverse_of(const glm::dvec3& d) {
    glm::dvec3 r;
    for (int k = 0; k < 3; ++k)
        r[k] = std::abs(d[k]) < 1e-300 ? std::copysign(1e300, d[k]) : 1 / d[k];
    return r;
}

double largest(const glm::dvec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

} // namespace

bool Extent::meets(const glm::dvec3& from, const glm::dvec3& inverse, double wider) const {
    double enter = -1e300, leave = 1e300;
    for (int k = 0; k < 3; ++k) {
        const double a = (low[k] - wider - from[k]) * inverse[k];
        const double b = (high[k] + wider - from[k]) * inverse[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    // Products of the box test are rounded; the boxes may be touched exactly.
    return enter <= leave + 1e-12 * (std::abs(enter) + std::abs(leave));
}

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
        g.triangles = triangles_in(first.triangles);
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
        Extent box;
        for (const glm::dvec3& p : g.anchors)
            box.add(p);
        if (g.part)
            for (const glm::dvec3& p : g.middle)
                box.add(p);
        boxes_.push_back({box.low + origin_of(g), box.high + origin_of(g)});
        extent_.add(boxes_.back());
        finest_ = grids_.empty() ? g.first_level : std::min(finest_, g.first_level);
        const int exponent =
            std::max({g.nu, g.nv, g.side[0].curve, g.side[1].curve, g.side[2].curve, g.side[3].curve});
        coarsest_ = std::max(grids_.empty() ? finest_ : coarsest_, g.first_level + exponent + 1);
        grids_.push_back(std::move(g));
    }
    std::vector<int> order(grids_.size());
    std::iota(order.begin(), order.end(), 0);
    build(order, 0, order.size());
}

glm::dvec3 FieldSurface::origin_of(const Grid& grid) const {
    return vec(origins_[static_cast<std::size_t>(grid.instance)]);
}

FieldSurface::Shape FieldSurface::shape(int patch) const {
    const Grid& g = grids_[static_cast<std::size_t>(patch)];
    return {g.nu, g.nv, g.first_level, g.triangles, origin_of(g)};
}

/// Halves the patches at the median along the box's longest side.
int FieldSurface::build(std::vector<int>& order, std::size_t begin, std::size_t end) {
    const auto number = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    Extent box;
    for (std::size_t i = begin; i < end; ++i)
        box.add(boxes_[static_cast<std::size_t>(order[i])]);
    if (end - begin == 1) {
        nodes_.back() = {box, order[begin], -1};
        return number;
    }
    const glm::dvec3 size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto middle_of = [&](int patch) {
        const Extent& b = boxes_[static_cast<std::size_t>(patch)];
        return b.low[axis] + b.high[axis];
    };
    const std::size_t middle = (begin + end) / 2;
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
                     [&](int a, int b) { return middle_of(a) < middle_of(b); });
    build(order, begin, middle);
    const int second = build(order, middle, end);
    nodes_[static_cast<std::size_t>(number)] = {box, -1, second};
    return number;
}

std::size_t FieldSurface::vertices() const {
    std::size_t n = 0;
    for (const Grid& g : grids_)
        n += g.anchors.size();
    return n;
}

SeenSurface::SeenSurface(const FieldSurface& surface, const Ray& asks)
    : surface_(surface), asks_(asks), number_(surface.grids_.size(), -1) {}

const SeenSurface::Blended& SeenSurface::blended(int patch) {
    int& number = number_[static_cast<std::size_t>(patch)];
    if (number >= 0)
        return blended_[static_cast<std::size_t>(number)];
    number = static_cast<int>(blended_.size());
    const FieldSurface::Grid& g = surface_.grids_[static_cast<std::size_t>(patch)];
    const glm::dvec3 from = vec(asks_.origin) - surface_.origin_of(g);
    const int across = 1 << g.nu, up = 1 << g.nv, width = across + 1;
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(j * width + i); };
    Blended seen{g.anchors, {}, 0};
    const auto blend = [&](int i, int j, int birth, const glm::dvec3& mean) {
        const glm::dvec3& anchor = g.anchors[at(i, j)];
        const glm::dvec3 way = anchor - from;
        const double blur = std::abs(asks_.base + glm::dot(vec(asks_.slope), way));
        const double w = weight(blur + asks_.growth * glm::length(way), birth);
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
        for (int j = 0; j <= up; j += std::min(step, up))
            for (int i = 0; i <= across; i += std::min(step, across)) {
                const bool end_u = i == 0 || i == across, end_v = j == 0 || j == up;
                const bool odd_u = !end_u && twos(i) == twos(step);
                const bool odd_v = !end_v && twos(j) == twos(step);
                if (!odd_u && !odd_v)
                    continue;
                const int di = odd_u ? step : 0, dj = odd_v ? step : 0;
                const glm::dvec3 mean =
                    0.5 * (seen.points[at(i - di, j - dj)] + seen.points[at(i + di, j + dj)]);
                int birth = g.first_level + twos(step);
                if (end_u || end_v) {
                    const FieldSurface::Side& side = g.side[j == 0 ? 0 : j == up ? 2 : i == across ? 1 : 3];
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
    for (int v = 0; v < up; v += tile_quads)
        for (int u = 0; u < across; u += tile_quads) {
            Extent box;
            for (int j = v; j <= std::min(v + tile_quads, up); ++j)
                for (int i = u; i <= std::min(u + tile_quads, across); ++i)
                    box.add(seen.points[at(i, j)]);
            seen.tiles.push_back(box);
        }
    blended_.push_back(std::move(seen));
    return blended_.back();
}

std::size_t SeenSurface::between() {
    std::size_t n = 0;
    for (std::size_t p = 0; p < number_.size(); ++p)
        n += blended(static_cast<int>(p)).between;
    return n;
}

namespace {

/// One ray against triangles, in double precision.
class Meeting {
public:
    Meeting(const glm::dvec3& from, const glm::dvec3& direction, double low, double high, double unit,
            bool certain, std::vector<SeenSurface::Crossing>& found)
        : from_(from), d_(direction), low_(low), high_(high), unit_(unit), certain_(certain), found_(found) {}

    void triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
        // Moeller, Trumbore
        const glm::dvec3 e1 = b - a, e2 = c - a, s = from_ - a;
        const glm::dvec3 p = glm::cross(d_, e2), q = glm::cross(s, e1);
        const double det = glm::dot(e1, p); // twice the area that the ray sees
        if (unit_ == 0) {
            if (det == 0)
                return;
            const double u = glm::dot(s, p) / det, v = glm::dot(d_, q) / det;
            if (u >= 0 && v >= 0 && u + v <= 1)
                take(glm::dot(e2, q) / det, 0);
            return;
        }
        const double e = error_at(a);
        const double l1 = glm::length(e1), l2 = glm::length(e2), l3 = glm::length(e1 - e2);
        const double wide = std::max({glm::length(glm::cross(d_, e1)), glm::length(glm::cross(d_, e2)),
                                      glm::length(glm::cross(d_, e1 - e2))}); // as the ray sees it
        if (std::abs(det) <= 8 * e * wide || wide <= 8 * e) {
            // No thicker than the error: what passes is met anywhere between its edges.
            if (!certain_)
                take_edges({a, b, c}, e, e + (wide > 0 ? std::abs(det) / wide : 0));
            return;
        }
        const double inverse = 1 / det;
        const double u = glm::dot(s, p) * inverse, v = glm::dot(d_, q) * inverse;
        // A ray moved by e changes a weight by e times the length of the edge where that is 0, over det.
        const double per = (certain_ ? -e : e) * std::abs(inverse);
        if (u < -per * l2 || v < -per * l1 || u + v > 1 + per * l3)
            return;
        const double cosine = std::abs(det) / glm::length(glm::cross(e1, e2));
        const double size = std::max({l1, l2, l3});
        take(glm::dot(e2, q) * inverse, e / cosine * (1 + size * size * std::abs(inverse)));
    }

private:
    /// How far the ray may be from where it is in single precision, near point p.
    double error_at(const glm::dvec3& p) const {
        return unit_ * (largest(p) + largest(from_) + largest(p - from_));
    }
    /// Where the ray passes no further than `off` from sides of a triangle that it sees edge-on.
    void take_edges(const std::array<glm::dvec3, 3>& vertex, double e, double off) const {
        double least = 1e300, most = -1e300;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec3 s = vertex[k] - from_, along = vertex[(k + 1) % 3] - vertex[k];
            // The point of the side that is nearest to the line.
            const double square_of_d = glm::dot(d_, d_);
            const glm::dvec3 sideways = along - glm::dot(along, d_) / square_of_d * d_;
            const double square = glm::dot(sideways, sideways);
            const double x = square == 0 ? 0 : std::clamp(-glm::dot(s, sideways) / square, 0.0, 1.0);
            const glm::dvec3 nearest = s + x * along;
            const double t = glm::dot(nearest, d_) / square_of_d;
            if (glm::length(nearest - t * d_) > off)
                continue;
            const double length = glm::length(along);
            const double sine = length > 0 ? std::sqrt(square) / length : 1;
            const double slack = std::min(length, 2 * off / std::max(sine, 1e-9)) + 2 * e;
            least = std::min(least, t - slack);
            most = std::max(most, t + slack);
        }
        if (least <= most)
            take(0.5 * (least + most), 0.5 * (most - least));
    }
    void take(double t, double slack) const {
        const double wider = certain_ ? -slack : slack;
        if (t >= low_ - wider && t <= high_ + wider)
            found_.push_back({t, slack});
    }

    glm::dvec3 from_, d_;
    double low_, high_, unit_;
    bool certain_;
    std::vector<SeenSurface::Crossing>& found_;
};

constexpr double unit_roundoff = 1.0 / 16777216;

} // namespace

void SeenSurface::meet_patch(int patch, const Ray& ray, double roundings, bool use_boxes,
                             std::vector<Crossing>& found) {
    const FieldSurface::Grid& g = surface_.grids_[static_cast<std::size_t>(patch)];
    const Blended& seen = blended(patch);
    const glm::dvec3 from = vec(ray.origin) - surface_.origin_of(g), d = vec(ray.direction);
    const glm::dvec3 inverse = inverse_of(d);
    const double unit = std::abs(roundings) * unit_roundoff;
    const Meeting meeting(from, d, ray.t_min, ray.t_max, unit, roundings < 0, found);
    const int across = 1 << g.nu, up = 1 << g.nv, width = across + 1;
    std::size_t tile = 0;
    for (int v = 0; v < up; v += tile_quads)
        for (int u = 0; u < across; u += tile_quads) {
            const Extent& box = seen.tiles[tile++];
            const double wider =
                4 * unit * (2 * std::max(largest(box.low), largest(box.high)) + 2 * largest(from));
            if (use_boxes && !box.meets(from, inverse, wider))
                continue;
            for (int j = v; j < std::min(v + tile_quads, up); ++j)
                for (int i = u; i < std::min(u + tile_quads, across); ++i) {
                    const auto at = static_cast<std::size_t>(j * width + i);
                    const auto next = at + static_cast<std::size_t>(width);
                    meeting.triangle(seen.points[at], seen.points[at + 1], seen.points[next + 1]);
                    if (g.triangles > 1)
                        meeting.triangle(seen.points[at], seen.points[next + 1], seen.points[next]);
                }
        }
}

std::vector<SeenSurface::Crossing> SeenSurface::crossings(const Ray& ray, double roundings) {
    std::vector<Crossing> found;
    const glm::dvec3 from = vec(ray.origin), inverse = inverse_of(vec(ray.direction));
    const Extent& all = surface_.extent();
    const double size = std::max(largest(all.low), largest(all.high)) + largest(from);
    const double wider = 16 * std::abs(roundings) * unit_roundoff * size + 1e-12 * size;
    int number = 0;
    std::vector<int> left;
    for (;;) {
        const FieldSurface::Node& node = surface_.nodes_[static_cast<std::size_t>(number)];
        if (node.box.meets(from, inverse, wider)) {
            if (node.patch < 0) {
                left.push_back(node.second);
                ++number;
                continue;
            }
            meet_patch(node.patch, ray, roundings, true, found);
        }
        if (left.empty())
            break;
        number = left.back();
        left.pop_back();
    }
    std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
    return found;
}

std::vector<SeenSurface::Crossing> SeenSurface::crossings_of_all(const Ray& ray, double roundings) {
    std::vector<Crossing> found;
    for (std::size_t p = 0; p < number_.size(); ++p)
        meet_patch(static_cast<int>(p), ray, roundings, false, found);
    std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
    return found;
}

bool SeenSurface::inside(const Point& p) {
    constexpr Point directions[3] = {
        {0.6831F, 0.2971F, 0.6671F}, {-0.3117F, 0.8837F, -0.3491F}, {0.1973F, -0.4127F, 0.8893F}};
    for (const Point& d : directions)
        if (crossings({.origin = p, .direction = d}, 0).size() % 2 == 0)
            return false;
    return true;
}

glm::dvec3 SeenSurface::feature(std::uint32_t number, std::uint32_t place, double along) {
    const auto patch = static_cast<int>(number % surface_.grids_.size());
    const FieldSurface::Grid& g = surface_.grids_[static_cast<std::size_t>(patch)];
    const Blended& seen = blended(patch);
    const int across = 1 << g.nu, up = 1 << g.nv;
    const int step = 1 << (place & 15) % static_cast<unsigned>(std::max(g.nu, g.nv) + 1);
    const auto pick = [&](std::uint32_t bits, int last) {
        const int most = std::max(last / step, 1);
        return std::min(static_cast<int>(bits % static_cast<unsigned>(most + 1)) * step, last);
    };
    const int i = pick(place >> 4 & 1023, across), j = pick(place >> 14 & 1023, up);
    const unsigned way = place >> 24 & 3; // along u, along v, along the diagonal
    const int i2 = way == 1 ? i : i < across ? i + 1 : i - 1;
    const int j2 = way == 0 ? j : j < up ? j + 1 : j - 1;
    const auto at = [&](int a, int b) { return seen.points[static_cast<std::size_t>(b * (across + 1) + a)]; };
    return at(i, j) + along * (at(i2, j2) - at(i, j)) + surface_.origin_of(g);
}

} // namespace razor::check
