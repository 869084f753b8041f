#include "tests/reference/continuity.h"

#include <cmath>

namespace razor::reference {

namespace {

class Path {
public:
    Path(const Structures& structures, const Setting& setting, const std::string& scheme,
         const glm::dvec3& origin)
        : structures_(structures), setting_(setting), scheme_(scheme), origin_(origin) {}

    /// What rays see at 2^x times half a target edge.
    std::unique_ptr<Tracer> at(double x) const {
        Setting s = setting_;
        s.w0 = std::exp2(x - 1);
        return make_tracer(scheme_, structures_, make_view(s, origin_));
    }
    bool near(const Hits& a, const Hits& b) const {
        bool hit = a.nearest.triangle >= 0;
        if (hit != (b.nearest.triangle >= 0))
            return false;
        return !hit || std::abs(a.nearest.t - b.nearest.t) <= 1e-3 * setting_.e0;
    }
    /// Halves a step in which the ray jumps; a step may hide several jumps, the first is followed.
    void follow(const Ray& ray, double x, Hits before, double y, Hits after, Jumps& jumps) const {
        while (y - x > 1e-9) {
            double middle = 0.5 * (x + y);
            Hits h = at(middle)->trace(ray);
            if (!near(before, h)) {
                y = middle;
                after = h;
            } else if (!near(h, after)) {
                x = middle;
                before = h;
            } else {
                return;
            }
        }
        ++(before.count == after.count ? jumps.pops : jumps.folds);
    }

private:
    const Structures& structures_;
    Setting setting_;
    std::string scheme_;
    glm::dvec3 origin_;
};

} // namespace

Jumps jumps(const Setting& setting, const std::string& scheme, double octaves, int steps_an_octave) {
    Levels levels = make_levels(setting);
    Structures structures(levels, setting.side);
    std::mt19937 random(setting.seed);
    Jumps result;
    std::vector<glm::dvec3> origins =
        inner_points(levels, make_case(setting.scene).inside, setting.origins, random);
    for (int i = 0; i < setting.origins; ++i)
        origins.push_back((2 + uniform(random)) * random_direction(random));
    for (std::size_t o = 0; o < origins.size(); ++o) {
        const glm::dvec3& origin = origins[o];
        Path path(structures, setting, scheme, origin);
        std::vector<Ray> rays;
        for (int i = 0; i < setting.rays; ++i) {
            glm::dvec3 d = random_direction(random);
            if (o >= origins.size() / 2) { // from outside, to where the mesh is
                std::size_t v = random() % levels.vertices().size();
                d = levels.vertices()[v].anchor + 0.05 * d - origin;
                d /= length(d);
            }
            rays.push_back({origin, d});
        }
        std::vector<Hits> before(rays.size());
        int last = static_cast<int>(octaves * steps_an_octave);
        for (int step = 0; step <= last; ++step) {
            double x = static_cast<double>(step) / steps_an_octave;
            std::unique_ptr<Tracer> tracer = path.at(x);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                Hits h = tracer->trace(rays[i]);
                if (step > 0) {
                    ++result.steps;
                    if (!path.near(before[i], h))
                        path.follow(rays[i], x - 1.0 / steps_an_octave, before[i], x, h, result);
                }
                before[i] = h;
            }
        }
    }
    return result;
}

} // namespace razor::reference
