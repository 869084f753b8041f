#include "razor/surface/ear_clipping.h"

#include <numeric>

namespace razor {
namespace {

/// What is left of the polygon, as corner numbers in order.
class Remainder {
public:
    explicit Remainder(std::span<const glm::dvec2> polygon) : polygon_(polygon), left_(polygon.size()) {
        std::iota(left_.begin(), left_.end(), 0);
    }

    std::size_t size() const { return left_.size(); }
    std::array<int, 3> triangle(std::size_t i) const {
        const std::size_t n = left_.size();
        return {left_[(i + n - 1) % n], left_[i], left_[(i + 1) % n]};
    }
    double area(std::size_t i) const {
        const auto [a, b, c] = triangle(i);
        return doubled_area(at(a), at(b), at(c));
    }
    /// Positive area, and no other point of the remainder in the closed triangle but such as coincide with
    /// its corners.
    bool is_ear(std::size_t i) const {
        if (!(area(i) > 0)) {
            return false;
        }
        const auto t = triangle(i);
        const glm::dvec2 a = at(t[0]), b = at(t[1]), c = at(t[2]);
        for (const int other : left_) {
            const glm::dvec2 p = at(other);
            if (p != a && p != b && p != c && doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 &&
                doubled_area(c, a, p) >= 0) {
                return false;
            }
        }
        return true;
    }
    void remove(std::size_t i) { left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i)); }

private:
    const glm::dvec2& at(int corner) const { return polygon_[static_cast<std::size_t>(corner)]; }

    std::span<const glm::dvec2> polygon_;
    std::vector<int> left_;
};

/// The next ear from `start` on; where there is none (points in a line, crossing sides), the corner of least
/// harm: one that takes no area away, else the first that turns left, else the first.
std::size_t choose(const Remainder& rest, std::size_t start) {
    const std::size_t n = rest.size();
    for (std::size_t k = 0; k < n; ++k) {
        if (const std::size_t i = (start + k) % n; rest.is_ear(i)) {
            return i;
        }
    }
    std::size_t left_turn = n;
    for (std::size_t i = 0; i < n; ++i) {
        const double area = rest.area(i);
        if (area == 0) {
            return i;
        }
        if (area > 0 && left_turn == n) {
            left_turn = i;
        }
    }
    return left_turn < n ? left_turn : 0;
}

} // namespace

double doubled_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

std::vector<std::array<int, 3>> clip_ears(std::span<const glm::dvec2> polygon) {
    std::vector<std::array<int, 3>> triangles;
    Remainder rest(polygon);
    std::size_t next = 0;
    while (rest.size() > 3) {
        const std::size_t i = choose(rest, next);
        triangles.push_back(rest.triangle(i));
        rest.remove(i);
        next = i % rest.size(); // the corner after the clipped one: spreads triangles round the outline
    }
    if (rest.size() == 3) {
        triangles.push_back(rest.triangle(1));
    }
    return triangles;
}

} // namespace razor
