#include "tests/benchmarks/embree/grid_mesh.h"

#include <algorithm>
#include <array>
#include <map>

namespace razor::baseline {
namespace {

std::size_t index(std::int64_t i) {
    return static_cast<std::size_t>(i);
}

/// Bilinear weights of the controls of a face, at the patch's corners and between them.
using CornerWeights = std::array<std::vector<double>, 4>;

CornerWeights quad_corners() {
    CornerWeights c;
    for (std::size_t k = 0; k < 4; ++k) {
        c[k].assign(4, 0.0);
        c[k][k] = 1;
    }
    return c;
}

CornerWeights sub_face_corners(int sub, int size) {
    CornerWeights c;
    for (std::vector<double>& w : c)
        w.assign(index(size), 0.0);
    const auto after = index((sub + 1) % size), before = index((sub + size - 1) % size);
    c[0][index(sub)] = 1;
    c[1][index(sub)] = c[1][after] = 0.5;
    std::fill(c[2].begin(), c[2].end(), 1.0 / size);
    c[3][index(sub)] = c[3][before] = 0.5;
    return c;
}

bool is_part(const PatchRecord& p) {
    return (p.side_flags[0] & side_half) != 0;
}
bool is_flat(const PatchRecord& p) {
    return p.kind == PatchKind::flat_quad || p.kind == PatchKind::flat_triangle;
}

class Maker {
public:
    Maker(const Topology& topology, const PageMaker* pages, int level) : t_(topology), pages_(pages) {
        mesh_.level = std::clamp(level, coarsest_level(t_), finest_level);
        points_.assign(t_.points.size(), -1);
        centres_.assign(t_.faces.size(), -1);
        curve_vertices_.assign(t_.curves.size() << mesh_.level, -1);
    }

    GridMesh make() {
        for (const PatchRecord& p : t_.patches)
            add_patch(p);
        return std::move(mesh_);
    }

private:
    void add_patch(const PatchRecord& p) {
        const int exponent = is_flat(p) ? 0 : mesh_.level - (is_part(p) ? 1 : 0);
        const int strips = strip_count(exponent), side = std::min(block_quads, 1 << exponent);
        const auto [first_control, controls] = add_controls(p);
        const std::int32_t first = mesh_.vertices;
        for (int row = 0; row < strips; ++row)
            for (int column = 0; column < strips; ++column) {
                const std::array<std::int64_t, 2> pages = page(p, exponent, column, row);
                const int vertices = (side + 1) * (side + 1);
                mesh_.blocks.push_back({pages[0], pages[1], row_floats(vertices), first_control, controls,
                                        mesh_.vertices, vertices});
                add_quads(p, mesh_.vertices, side);
                mesh_.vertices += vertices;
            }
        const int quads = 1 << exponent;
        const auto vertex = [&](int i, int j) {
            const int column = std::min(i / side, strips - 1), row = std::min(j / side, strips - 1);
            return first + (row * strips + column) * (side + 1) * (side + 1) + (j - row * side) * (side + 1) +
                   (i - column * side);
        };
        weld_corners(p, {vertex(0, 0), vertex(quads, 0), vertex(quads, quads), vertex(0, quads)});
        // Blocks of a patch meet in vertices that are evaluated alike.
        for (int i = 1; i < quads; ++i) {
            weld(p, 0, i, vertex(i, 0));
            weld(p, 1, i, vertex(quads, i));
            weld(p, 2, i, vertex(i, quads));
            weld(p, 3, i, vertex(0, i));
        }
        // Those of two blocks on a side are one vertex each block.
        for (int i = side; i < quads; i += side) {
            const int left = i / side - 1;
            const auto twin = [&](int column, int row, int x, int y) {
                return first + (row * strips + column) * (side + 1) * (side + 1) + y * (side + 1) + x;
            };
            weld(p, 0, i, twin(left, 0, side, 0));
            weld(p, 1, i, twin(strips - 1, left, side, side));
            weld(p, 2, i, twin(left, strips - 1, side, side));
            weld(p, 3, i, twin(0, left, 0, side));
        }
    }

    std::pair<std::int32_t, std::int32_t> add_controls(const PatchRecord& p) {
        const auto first = static_cast<std::int32_t>(mesh_.controls.size());
        const FaceRecord& face = t_.faces[index(p.face)];
        if (p.kind == PatchKind::catmull_clark || is_part(p)) {
            if (p.face != last_face_) {
                last_face_ = p.face;
                last_controls_ = first;
                const auto from = t_.controls.begin() + face.control_first;
                mesh_.controls.insert(mesh_.controls.end(), from, from + face.control_count);
            }
            return {last_controls_, face.control_count};
        }
        mesh_.controls.insert(mesh_.controls.end(), std::begin(p.corner), std::end(p.corner));
        return {first, 4};
    }

    static std::int32_t row_floats(int vertices) {
        return (vertices + RAZOR_WIDTH - 1) / RAZOR_WIDTH * RAZOR_WIDTH;
    }

    /// Positions' and derivatives' weights; alike for all patches of a class.
    std::array<std::int64_t, 2> page(const PatchRecord& p, int exponent, int column, int row) {
        const FaceRecord& face = t_.faces[index(p.face)];
        const int kind = p.kind == PatchKind::catmull_clark ? face.face_class
                         : is_flat(p)                       ? -1
                         : is_part(p)                       ? -2 - face.corner_count
                                                            : -2;
        const auto [found, fresh] = made_.try_emplace({kind, p.sub * (kind == -1 ? 0 : 1), column, row});
        if (fresh)
            found->second = kind >= 0 ? limit_page(face, p.sub, exponent, column, row)
                                      : bilinear_page(p, face.corner_count, exponent, column, row);
        return found->second;
    }

    std::array<std::int64_t, 2> limit_page(const FaceRecord& face, int sub, int exponent, int column,
                                           int row) {
        std::array<std::int64_t, 2> at{};
        for (std::size_t k = 0; k < 2; ++k) {
            const PageKey key{.face_class = face.face_class,
                              .kind = k == 0 ? PageKind::block : PageKind::derivative,
                              .local = sub,
                              .exponent_u = exponent,
                              .strip_u = column,
                              .exponent_v = exponent,
                              .strip_v = row};
            at[k] = static_cast<std::int64_t>(mesh_.weights.size());
            mesh_.weights.resize(mesh_.weights.size() + page_floats(key, face.control_count));
            pages_->make(key, mesh_.weights.data() + at[k]);
        }
        return at;
    }

    std::array<std::int64_t, 2> bilinear_page(const PatchRecord& p, int size, int exponent, int column,
                                              int row) {
        const CornerWeights corner = is_part(p) ? sub_face_corners(p.sub, size) : quad_corners();
        const std::size_t controls = corner[0].size();
        const int side = std::min(block_quads, 1 << exponent);
        const auto width = index(row_floats((side + 1) * (side + 1)));
        const auto at = mesh_.weights.size();
        mesh_.weights.resize(at + 3 * controls * width, 0.0F);
        float* positions = mesh_.weights.data() + at;
        float* slopes = positions + controls * width;
        std::size_t vertex = 0;
        for (int j = 0; j <= side; ++j)
            for (int i = 0; i <= side; ++i, ++vertex) {
                const double u = static_cast<double>(column * block_quads + i) / (1 << exponent);
                const double v = static_cast<double>(row * block_quads + j) / (1 << exponent);
                const std::array<double, 4> w{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
                const std::array<double, 4> du{v - 1, 1 - v, v, -v}, dv{u - 1, -u, u, 1 - u};
                for (std::size_t c = 0; c < controls; ++c) {
                    double sum[3] = {};
                    for (std::size_t k = 0; k < 4; ++k) {
                        sum[0] += w[k] * corner[k][c];
                        sum[1] += du[k] * corner[k][c];
                        sum[2] += dv[k] * corner[k][c];
                    }
                    positions[c * width + vertex] = static_cast<float>(sum[0]);
                    slopes[2 * c * width + vertex] = static_cast<float>(sum[1]);
                    slopes[(2 * c + 1) * width + vertex] = static_cast<float>(sum[2]);
                }
            }
        const auto first = static_cast<std::int64_t>(at);
        return {first, is_flat(p) ? -1 : first + static_cast<std::int64_t>(controls * width)};
    }

    void add_quads(const PatchRecord& p, int first, int side) {
        const bool triangle = p.kind == PatchKind::flat_triangle;
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) {
                const int low = first + j * (side + 1) + i, high = low + side + 1;
                // From the corner that both triangles begin with; of a triangle Embree's second one is none.
                const std::array<int, 4> quad = triangle ? std::array{high + 1, low, low + 1, low + 1}
                                                         : std::array{high, low, low + 1, high + 1};
                mesh_.quads.insert(mesh_.quads.end(), quad.begin(), quad.end());
                mesh_.triangles += triangle ? 1 : 2;
            }
    }

    void join(std::int32_t& first, int vertex) {
        if (first < 0)
            first = vertex;
        else if (first != vertex)
            mesh_.welds.push_back({vertex, first});
    }

    std::int32_t& on_curve(int curve, int step) {
        return curve_vertices_[(index(curve) << mesh_.level) + index(step)];
    }

    void weld_corners(const PatchRecord& p, const std::array<int, 4>& vertex) {
        for (std::size_t k = 0; k < 4; ++k) {
            if (!is_part(p) || k == 0)
                join(points_[index(p.corner[k])], vertex[k]);
            else if (k == 2)
                join(centres_[index(p.face)], vertex[k]);
            else
                join(on_curve(p.corner[k], 1 << (mesh_.level - 1)), vertex[k]);
        }
    }

    /// The vertex `i` steps along a side that has more than one.
    void weld(const PatchRecord& p, int side, int i, int vertex) {
        const int curve = p.side_curve[side], flags = p.side_flags[side];
        if (curve < 0)
            return;
        const bool spoke = (t_.curves[index(curve)].flags & curve_spoke) != 0;
        const int segments = 1 << (mesh_.level - (spoke ? 1 : 0));
        join(on_curve(curve, (flags & side_reversed) != 0 ? segments - i : i), vertex);
    }

    const Topology& t_;
    const PageMaker* pages_;
    GridMesh mesh_;
    std::vector<std::int32_t> points_, centres_, curve_vertices_; // the first vertex there
    std::map<std::array<int, 4>, std::array<std::int64_t, 2>> made_;
    int last_face_ = -1;
    std::int32_t last_controls_ = 0;
};

} // namespace

std::int64_t GridMesh::bytes() const {
    return static_cast<std::int64_t>(blocks.size() * sizeof(GridBlock) + weights.size() * sizeof(float) +
                                     controls.size() * 4 + quads.size() * 4 + welds.size() * sizeof(Weld));
}

/// Halves of edges need edges of two segments at least.
int coarsest_level(const Topology& topology) {
    return std::any_of(topology.patches.begin(), topology.patches.end(), is_part) ? 1 : 0;
}

std::int64_t triangles_at(const Topology& topology, int level) {
    const int possible = std::clamp(level, coarsest_level(topology), finest_level);
    std::int64_t triangles = 0;
    for (const PatchRecord& p : topology.patches)
        triangles += p.kind == PatchKind::flat_triangle ? 1
                     : is_flat(p)                       ? 2
                                  : std::int64_t{2} << (2 * (possible - (is_part(p) ? 1 : 0)));
    return triangles;
}

GridMesh make_grid_mesh(const Topology& topology, const PageMaker* pages, int level) {
    return Maker(topology, pages, level).make();
}

} // namespace razor::baseline
