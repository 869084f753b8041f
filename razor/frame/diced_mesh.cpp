#include "razor/frame/diced_mesh.h"

#include "razor/frame/transition.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace razor {
namespace {

using glm::dvec3;

/// The camera's field in an instance's coordinates, and the weights that follow from it.
struct Field {
    dvec3 origin, slope;
    double base, growth;

    double weight(const dvec3& anchor, int birth) const {
        const dvec3 way = anchor - origin;
        const double blur = std::abs(base + glm::dot(slope, way));
        const double target = blur + growth * glm::length(way);
        // Design: razor/kernels/morph.h.
        const double part = std::ldexp(target * level_rounding, -birth - 1); // of what it is gone at
        const double x = std::clamp((part - morph_begin) / (1 - morph_begin), 0.0, 1.0);
        return 1 - x * x * (3 - 2 * x);
    }
};

dvec3 vec(const float* p) {
    return {p[0], p[1], p[2]};
}

struct Block {
    const BlockHeader* header;
    const float* words;
};

std::uint64_t pair_key(int a, int b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint64_t>(std::max(a, b));
}

struct PointHash {
    std::size_t operator()(const std::array<double, 3>& p) const {
        std::uint64_t h = 0;
        for (const double x : p)
            h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ULL + (h >> 29);
        return static_cast<std::size_t>(h ^ h >> 32);
    }
};

/// What is known of a patch's grid, in steps of its finest level.
struct Grid {
    int across, up; // steps
    int first_level;
    bool part; // of an n-gon: corners 1 and 3 are middles of edges
    struct Side {
        int curve, exponent; // of the whole curve: at level 0, or straight_curve; of the grid along it
    } side[4];
    const BlockHeader* root;
};

class InstanceBuilder {
public:
    InstanceBuilder(Frame& frame, const InstanceRecord& record, const std::function<void()>& look)
        : frame_(frame), record_(record), look_(look) {
        const FrameHeader& h = frame.header();
        const dvec3 origin = vec(record.origin);
        field_ = {vec(h.field_origin) - origin, vec(h.camera_slope), h.camera_base, h.camera_growth};
        morphs_ = h.morphs != 0 && h.level_choice == by_leaf;
        // Of what a mirror turned over, counter-clockwise is clockwise.
        mirrored_ = record.moved < 0;
        world_ = frame.origin() + frame.unit() * origin;
        out_.mesh = record.mesh;
    }

    DicedInstance build() {
        for (int p = 0; p < record_.patch_count; ++p)
            add_patch(record_.first_patch + p);
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            if (t % 1024 == 0)
                look_();
            add_face(triangles_[t]);
        }
        for (dvec3& p : out_.points)
            p = world_ + frame_.unit() * p;
        return std::move(out_);
    }

private:
    using Corner = DicedInstance::Corner;
    using Triangle = std::array<Corner, 3>;

    struct Vertex {
        dvec3 anchor{0};
        dvec3 position{0};
        glm::vec3 normal{0};
        bool placed = false;
        bool gone = false; // at the mean of its parents
        int point = -1, corner_normal = -1;
        int one = -1, other = -1; // parents: points
    };

    int point_of(const dvec3& p) {
        const auto [entry, is_new] =
            points_.try_emplace({p.x + 0.0, p.y + 0.0, p.z + 0.0}, static_cast<int>(out_.points.size()));
        if (is_new)
            out_.points.push_back(p);
        return entry->second;
    }
    int normal_of(const glm::vec3& n) {
        out_.normals.push_back(mirrored_ ? -n : n);
        return static_cast<int>(out_.normals.size()) - 1;
    }

    void collect(int line, std::vector<Block>& all, std::vector<Block>& finest) const {
        const Line* at = frame_.header().grids.get() + line;
        const Block b{reinterpret_cast<const BlockHeader*>(at), reinterpret_cast<const float*>(at)};
        all.push_back(b);
        if (b.header->level == 0 || b.header->children.word != ready) {
            finest.push_back(b);
            return;
        }
        for (int k = 0; k < children_in(b.header->child_shape); ++k)
            collect(b.header->child_line + k * lines_between(b.header->child_shape), all, finest);
    }

    static int twos(int i) { return std::countr_zero(static_cast<unsigned>(i)); }

    /// Between its anchor and the mean of the points a and b.
    void settle(Vertex& v, double weight, const dvec3& a, const dvec3& b) {
        const dvec3 mean = 0.5 * (a + b);
        v.gone = weight == 0;
        v.position = v.gone ? mean : weight * v.anchor + (1 - weight) * mean;
        if (v.gone) {
            v.one = point_of(a);
            v.other = point_of(b);
        }
    }

    void place_corner(const Grid& g, int i, int j, Vertex& v) {
        v.position = v.anchor;
        if (!g.part || (i == 0) == (j == 0)) // a cage point or a centre
            return;
        const int edge = i != 0 ? 0 : 1, side = i != 0 ? 0 : 3;
        const auto* words = reinterpret_cast<const float*>(g.root);
        const dvec3 near = vertex(g, 0, 0).anchor;
        const dvec3 far = vec(words + g.root->middles + ends_far + 3 * edge);
        if (g.side[side].curve == straight_curve) {
            settle_straight(v, near, far);
            return;
        }
        const int birth = g.first_level + g.side[side].curve - 1;
        settle(v, g.side[side].curve < 1 ? 0.0 : weight(v.anchor, birth), near, far);
    }
    /// On a straight edge: neighbours may have nothing there.
    void settle_straight(Vertex& v, const dvec3& a, const dvec3& b) {
        v.position = v.anchor;
        v.gone = true;
        v.one = point_of(a);
        v.other = point_of(b);
    }
    double weight(const dvec3& anchor, int birth) const { return morphs_ ? field_.weight(anchor, birth) : 1; }

    Vertex& vertex(const Grid& g, int i, int j) {
        Vertex& v = vertices_.at(j * (g.across + 1) + i);
        if (v.placed)
            return v;
        v.placed = true;
        const bool end_u = i == 0 || i == g.across, end_v = j == 0 || j == g.up;
        if (end_u && end_v) {
            place_corner(g, i, j, v);
        } else {
            constexpr int always = 31;
            const int log = std::min(end_u ? always : twos(i), end_v ? always : twos(j)), step = 1 << log;
            const int di = !end_u && twos(i) == log ? step : 0, dj = !end_v && twos(j) == log ? step : 0;
            const Vertex a = vertex(g, i - di, j - dj), b = vertex(g, i + di, j + dj);
            int birth = g.first_level + log;
            bool straight = false;
            if (end_u || end_v) {
                const Grid::Side& side = g.side[j == 0 ? 0 : j == g.up ? 2 : i == g.across ? 1 : 3];
                straight = side.curve == straight_curve;
                birth += side.curve - side.exponent;
            }
            if (straight)
                settle_straight(v, a.position, b.position);
            else
                settle(v, birth < g.first_level ? 0.0 : weight(v.anchor, birth), a.position, b.position);
            // Shaded as it is seen: between the same parents.
            if (v.gone && glm::length(a.normal + b.normal) > 0)
                v.normal = glm::normalize(a.normal + b.normal);
        }
        v.point = point_of(v.position);
        return v;
    }

    void add_patch(int patch) {
        const FrameHeader& h = frame_.header();
        const OpenPatch& open = h.trees.get()[0].patches.get()[patch];
        if (open.state.word != ready)
            return;
        std::vector<Block> all, finest;
        collect(open.root, all, finest);
        const PatchRecord& record = h.patches.get()[record_.first_record + (patch - record_.first_patch)];
        const BlockHeader& root = *all.front().header;
        Grid g{};
        g.root = &root;
        g.first_level = record_.first_level;
        const int nu = root.exponent[0] + root.level, nv = root.exponent[1] + root.level;
        g.across = 1 << nu;
        g.up = 1 << nv;
        g.part = record.kind < PatchKind::flat_quad && (record.side_flags[0] & side_half) != 0;
        vertices_.clear();
        for (const Block& b : all) {
            look_();
            const BlockHeader& block = *b.header;
            for (int s = 0; s < 4; ++s)
                if (block.curve[s] != inner_side) {
                    const bool half = record.side_curve[s] >= 0 && (record.side_flags[s] & side_half) != 0;
                    g.side[s] = {block.curve[s], (s % 2 == 0 ? nu : nv) + (half ? 1 : 0)};
                }
            const bool shaded = block.normals_at != 0 && block.normals.word == ready;
            for (int k = 0; k < block.stride; ++k) {
                const int i = (block.column * block_quads + k % (block.quads_u + 1)) << block.level;
                const int j = (block.row * block_quads + k / (block.quads_u + 1)) << block.level;
                Vertex& v = vertices_[j * (g.across + 1) + i];
                const float* x = b.words + block_header_words + k;
                v.anchor = {x[0], x[block.stride], x[2 * block.stride]};
                if (shaded) {
                    const float* n = b.words + block.normals_at + k;
                    v.normal = {n[0], n[block.stride], n[2 * block.stride]};
                }
            }
        }
        for (const Block& b : finest) {
            look_();
            add_block(g, b);
        }
    }

    void add_block(const Grid& g, const Block& b) {
        const BlockHeader& block = *b.header;
        const int step = 1 << block.level;
        for (int row = 0; row < block.quads_v; ++row)
            for (int column = 0; column < block.quads_u; ++column) {
                const int i = (block.column * block_quads + column) << block.level;
                const int j = (block.row * block_quads + row) << block.level;
                const std::array<std::array<int, 2>, 4> at{
                    {{i, j}, {i + step, j}, {i + step, j + step}, {i, j + step}}};
                add_triangle(g, at[0], at[1], at[2]);
                if (triangles_in(block.triangles) > 1)
                    add_triangle(g, at[0], at[2], at[3]);
            }
    }

    void add_triangle(const Grid& g, const std::array<int, 2>& a, const std::array<int, 2>& b,
                      const std::array<int, 2>& c) {
        std::array<Vertex*, 3> v{&vertex(g, a[0], a[1]), &vertex(g, b[0], b[1]), &vertex(g, c[0], c[1])};
        const dvec3 across = glm::cross(v[1]->position - v[0]->position, v[2]->position - v[0]->position);
        const double size = glm::length(across);
        const auto flat = glm::vec3(size > 0 ? across / size : dvec3(0, 0, 1));
        int flat_normal = -1;
        Triangle t;
        for (std::size_t k = 0; k < 3; ++k) {
            if (v[k]->gone)
                middles_.try_emplace(pair_key(v[k]->one, v[k]->other), v[k]->point);
            t[k].point = v[k]->point;
            if (glm::length(v[k]->normal) > 0) {
                if (v[k]->corner_normal < 0)
                    v[k]->corner_normal = normal_of(v[k]->normal);
                t[k].normal = v[k]->corner_normal;
            } else {
                flat_normal = flat_normal < 0 ? normal_of(flat) : flat_normal;
                t[k].normal = flat_normal;
            }
        }
        if (mirrored_)
            std::swap(t[1], t[2]);
        triangles_.push_back(t);
    }

    /// Appends a, then what others have on the edge from a to b.
    void add_edge(const Corner& a, const Corner& b, std::vector<Corner>& face) {
        const auto middle = a.point == b.point ? middles_.end() : middles_.find(pair_key(a.point, b.point));
        if (middle == middles_.end() || middle->second == a.point || middle->second == b.point) {
            face.push_back(a);
            return;
        }
        const glm::vec3 mean = out_.normals[static_cast<std::size_t>(a.normal)] +
                               out_.normals[static_cast<std::size_t>(b.normal)];
        const float length = glm::length(mean);
        Corner c{middle->second, a.normal};
        if (length > 0 && a.normal != b.normal) {
            out_.normals.push_back(mean / length);
            c.normal = static_cast<int>(out_.normals.size()) - 1;
        }
        add_edge(a, c, face);
        add_edge(c, b, face);
    }

    void add_face(const Triangle& t) {
        std::vector<Corner> corners, face;
        for (std::size_t k = 0; k < 3; ++k)
            add_edge(t[k], t[(k + 1) % 3], corners);
        for (const Corner& c : corners) // where points meet, an edge has no length
            if (face.empty() || face.back().point != c.point)
                face.push_back(c);
        while (face.size() > 1 && face.front().point == face.back().point)
            face.pop_back();
        if (face.size() < 3)
            return;
        out_.face_sizes.push_back(static_cast<int>(face.size()));
        out_.corners.insert(out_.corners.end(), face.begin(), face.end());
    }

    Frame& frame_;
    const InstanceRecord& record_;
    const std::function<void()>& look_;
    Field field_{};
    bool morphs_ = false, mirrored_ = false;
    dvec3 world_{0};
    DicedInstance out_;
    std::unordered_map<std::array<double, 3>, int, PointHash> points_;
    std::unordered_map<std::uint64_t, int> middles_; // of two points: the one between them that someone has
    std::unordered_map<int, Vertex> vertices_;       // of the patch at hand
    std::vector<Triangle> triangles_;
};

} // namespace

std::vector<DicedInstance> diced_mesh(Frame& frame, const std::function<void()>& look) {
    std::vector<DicedInstance> all;
    for (int n = 0; n < frame.instances(); ++n)
        all.push_back(InstanceBuilder(frame, frame.header().instances.get()[n], look).build());
    return all;
}

} // namespace razor
