// Each class keeps one Bfr surface, that of its representative, built by whoever asks first. The factory's
// own cache stays off: it would be asked once a class only. Classes that Bfr gets wrong ask Far instead.
#include "razor/surface/pages.h"

#include "razor/surface/bicubic_cells.h"
#include "razor/surface/far_stencils.h"
#include "razor/surface/refiner.h"

#include <fmt/format.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <unordered_map>

namespace razor {
namespace {

namespace Bfr = OpenSubdiv::Bfr;
using Factory = Bfr::RefinerSurfaceFactory<>;
using Uv = std::array<double, 2>;

struct ClassSurface {
    std::once_flag built;
    Bfr::Surface<double> surface;
    std::vector<int> to_control; // from Bfr's control points to positions in the face's control list
    std::unordered_map<int, int> position; // in the control list, of each mesh point
    std::unique_ptr<BicubicCells> cells;   // null: every point is asked for
};

/// Position in our regular control list of each point of Bfr's 4 x 4 patch, row by row.
constexpr std::array<int, 16> regular_order{5, 6, 7, 8, 4, 0, 1, 9, 15, 3, 2, 10, 14, 13, 12, 11};

std::unordered_map<int, int> positions_of(std::span<const int> controls) {
    std::unordered_map<int, int> position;
    for (std::size_t i = 0; i < controls.size(); ++i) {
        position.emplace(controls[i], static_cast<int>(i));
    }
    return position;
}

std::vector<int> map_controls(const Bfr::Surface<double>& surface, const FaceClass& c,
                              const std::unordered_map<int, int>& position) {
    if (c.regular) {
        if (!surface.IsRegular() || surface.GetNumControlPoints() != 16) {
            throw std::logic_error(fmt::format("face {} is not regular to OpenSubdiv", c.representative));
        }
        return {regular_order.begin(), regular_order.end()};
    }
    std::vector<int> theirs(static_cast<std::size_t>(surface.GetNumControlPoints()));
    surface.GetControlPointIndices(theirs.data());
    std::vector<int> map;
    for (const int point : theirs) {
        const auto found = position.find(point);
        if (found == position.end()) {
            throw std::logic_error(fmt::format("face {} depends on point {}, which its control list lacks",
                                               c.representative, point));
        }
        map.push_back(found->second);
    }
    return map;
}

/// Weights of one point of a surface, summed over repeated control points.
class StencilEvaluator {
public:
    /// `far`: null, or what to ask instead of Bfr.
    StencilEvaluator(const ClassSurface& entry, const FaceClass& c, const FarStencils* far)
        : entry_(entry), class_(c), far_(far), parameters_(OpenSubdiv::Sdc::SCHEME_CATMARK, c.corner_count),
          cells_(entry.cells.get(), [this](int sub, Uv uv) -> const std::vector<double>& {
              evaluate_alone(sub, uv, 0);
              return positions();
          }) {
        for (std::size_t k = 0; k < raw_.size(); ++k) {
            raw_[k].resize(entry.to_control.size());
            summed_[k].resize(static_cast<std::size_t>(c.control_count));
        }
    }
    StencilEvaluator(const StencilEvaluator&) = delete;
    StencilEvaluator& operator=(const StencilEvaluator&) = delete;

    /// Sub-face coordinates in [0,1]^2 (of the face itself if it is a quad), by which derivatives are.
    /// `order`: of those that are wanted.
    void evaluate(int sub, Uv uv, int order) {
        if (!cells_.evaluate(sub, uv, order, summed_)) {
            evaluate_alone(sub, uv, order);
        }
    }

    /// Position weights of the point evaluated last.
    const std::vector<double>& positions() const { return summed_[0]; }

    /// Writes row after row's entry `column`; which: 0 position, 1 d/du, 2 d/dv, 3 d2/du2, 4 d2/dudv, 5
    /// d2/dv2.
    void store(std::size_t which, float* rows, std::size_t row_stride, std::size_t column) const {
        for (std::size_t c = 0; c < summed_[which].size(); ++c) {
            rows[c * row_stride + column] = static_cast<float>(summed_[which][c]);
        }
    }

private:
    void evaluate_alone(int sub, Uv uv, int order) {
        for (std::vector<double>& weights : summed_) {
            std::fill(weights.begin(), weights.end(), 0.0);
        }
        if (class_.straight) {
            add_straight(sub, uv);
            return;
        }
        if (far_ != nullptr) {
            far_->add(class_.representative, sub, uv, entry_.position, summed_);
            return;
        }
        if (class_.corner_count != 4) {
            const Uv normalized = uv;
            parameters_.ConvertNormalizedSubFaceToCoord(sub, normalized.data(), uv.data());
        }
        if (order == 2) {
            entry_.surface.EvaluateStencil(uv.data(), raw_[0].data(), raw_[1].data(), raw_[2].data(),
                                           raw_[3].data(), raw_[4].data(), raw_[5].data());
        } else if (order == 1) {
            entry_.surface.EvaluateStencil(uv.data(), raw_[0].data(), raw_[1].data(), raw_[2].data());
        } else {
            entry_.surface.EvaluateStencil(uv.data(), raw_[0].data());
        }
        const std::size_t rows = order == 2 ? 6 : order == 1 ? 3 : 1;
        for (std::size_t k = 0; k < rows; ++k) {
            // A sub-face is half as long as Bfr's coordinates are on it.
            const double scale = class_.corner_count == 4 || k == 0 ? 1 : k < 3 ? 0.5 : 0.25;
            for (std::size_t i = 0; i < entry_.to_control.size(); ++i) {
                summed_[k][static_cast<std::size_t>(entry_.to_control[i])] += scale * raw_[k][i];
            }
        }
    }

    /// Bilinear between a quad's corners, or those of a sub-face: a corner, two middles of edges, the mean of
    /// all.
    void add_straight(int sub, Uv uv) {
        const auto n = static_cast<std::size_t>(class_.corner_count);
        const auto s = static_cast<std::size_t>(sub);
        const std::array<double, 4> u{1 - uv[0], uv[0], uv[0], 1 - uv[0]}, du{-1, 1, 1, -1},
            v{1 - uv[1], 1 - uv[1], uv[1], uv[1]}, dv{-1, -1, 1, 1};
        for (std::size_t k = 0; k < 4; ++k) {
            const std::array<double, 6> weight{u[k] * v[k], du[k] * v[k], u[k] * dv[k], 0, du[k] * dv[k], 0};
            for (std::size_t row = 0; row < weight.size(); ++row) {
                std::vector<double>& sum = summed_[row];
                if (n == 4) {
                    sum[k] += weight[row];
                } else if (k == 2) {
                    for (double& x : sum) {
                        x += weight[row] / static_cast<double>(n);
                    }
                } else {
                    sum[s] += weight[row] / 2;
                    sum[k == 0 ? s : k == 1 ? (s + 1) % n : (s + n - 1) % n] += weight[row] / 2;
                }
            }
        }
    }

    const ClassSurface& entry_;
    const FaceClass& class_;
    const FarStencils* far_;
    Bfr::Parameterization parameters_;
    std::array<std::vector<double>, 6> raw_, summed_;
    BicubicCells::Reader cells_;
};

struct SubPoint {
    int sub;
    Uv uv;
};

/// The point at parameter t of local curve `local`, in the direction of the face (spokes: towards the
/// centre).
SubPoint on_curve(int local, double t, int corners) {
    if (local >= corners) {
        return {local - corners, {1, t}};
    }
    if (corners != 4) {
        return t <= 0.5 ? SubPoint{local, {2 * t, 0}} : SubPoint{(local + 1) % corners, {0, 2 * (1 - t)}};
    }
    const std::array<Uv, 4> along{{{t, 0}, {1, t}, {1 - t, 1}, {0, 1 - t}}};
    return {0, along[static_cast<std::size_t>(local)]};
}

SubPoint at_vertex(int local, int corners) {
    if (corners != 4) {
        return local == corners ? SubPoint{0, {1, 1}} : SubPoint{local, {0, 0}};
    }
    constexpr std::array<Uv, 5> corner{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}}};
    return {0, corner[static_cast<std::size_t>(local)]};
}

/// Exact in double: the same point gets the same parameter from every block and chunk.
double dyadic(int strip, int i, int exponent) {
    return static_cast<double>(block_quads * strip + i) / (1 << exponent);
}

int quads(int exponent) {
    return std::min(block_quads, 1 << exponent);
}

/// The first of the two parents of a vertex born at (i, j), one of which is odd; the other is as far on.
std::array<int, 2> towards_parent(int i, int j) {
    return {i % 2, j % 2};
}

/// How far the weights of the next level's vertices are from the means of their parents' weights, at most,
/// for each control point; doubled for all levels after it. From level to level deviations of a smooth
/// surface fall to a quarter, beside extraordinary points at worst to about a half.
void bound_deviation(StencilEvaluator& stencil, const PageKey& key, int controls, float* bounds) {
    const int nu = 2 * quads(key.exponent_u), nv = 2 * quads(key.exponent_v);
    const auto n = static_cast<std::size_t>(controls);
    std::vector<double> weights(static_cast<std::size_t>((nu + 1) * (nv + 1)) * n);
    const auto at = [&](int i, int j) {
        return weights.data() + static_cast<std::size_t>(j * (nu + 1) + i) * n;
    };
    for (int j = 0; j <= nv; ++j) {
        for (int i = 0; i <= nu; ++i) {
            const double u = static_cast<double>(2 * block_quads * key.strip_u + i) / (2 << key.exponent_u);
            const double v = static_cast<double>(2 * block_quads * key.strip_v + j) / (2 << key.exponent_v);
            stencil.evaluate(key.local, {u, v}, 0);
            std::copy(stencil.positions().begin(), stencil.positions().end(), at(i, j));
        }
    }
    for (int j = 0; j <= nv; ++j) {
        for (int i = 0; i <= nu; ++i) {
            const auto [di, dj] = towards_parent(i, j);
            if (di + dj == 0) {
                continue;
            }
            const double* here = at(i, j);
            const double* one = at(i - di, j - dj);
            const double* other = at(i + di, j + dj);
            for (std::size_t k = 0; k < n; ++k) {
                const double off = std::abs(here[k] - 0.5 * (one[k] + other[k]));
                bounds[k] = std::max(bounds[k], static_cast<float>(2 * off));
            }
        }
    }
}

/// Where the control points of a regular face lie in its parameters, about the middle, if the surface is flat
/// and evenly spaced: a B-spline surface takes such control points to just that. Each row of length 1.
void place_regular_controls(float* along_u, float* along_v) {
    const double unit = 1 / std::sqrt(20.0); // sum of (i - 1.5)^2 over 4 x 4
    for (std::size_t j = 0; j < 4; ++j) {
        for (std::size_t i = 0; i < 4; ++i) {
            const auto k = static_cast<std::size_t>(regular_order[j * 4 + i]);
            along_u[k] = static_cast<float>((static_cast<double>(i) - 1.5) * unit);
            along_v[k] = static_cast<float>((static_cast<double>(j) - 1.5) * unit);
        }
    }
}

} // namespace

struct PageMaker::Impl {
    Impl(const Mesh& mesh, const Topology& t, int level)
        : topology(t), surfaces(t.classes.size()), chaikin(mesh.crease_method == CreaseMethod::chaikin) {
        if (mesh.scheme == Scheme::bilinear) {
            return;
        }
        refiner = make_refiner(mesh);
        factory.emplace(*refiner, Bfr::SurfaceFactory::Options()
                                      .EnableCaching(false)
                                      .SetApproxLevelSmooth(level)
                                      .SetApproxLevelSharp(level));
        std::vector<int> faces;
        for (const FaceClass& c : t.classes) {
            if (asks_far(c)) {
                faces.push_back(c.representative);
            }
        }
        if (!faces.empty()) {
            far = std::make_unique<FarStencils>(mesh, faces, level);
        }
    }

    bool asks_far(const FaceClass& c) const { return !c.straight && !c.regular && (chaikin || c.folded); }

    const ClassSurface& surface(int face_class) {
        ClassSurface& entry = surfaces[static_cast<std::size_t>(face_class)];
        std::call_once(entry.built, [&] {
            const FaceClass& c = topology.classes[static_cast<std::size_t>(face_class)];
            const FaceRecord& face = topology.faces[static_cast<std::size_t>(c.representative)];
            entry.position = positions_of(std::span(topology.controls)
                                              .subspan(static_cast<std::size_t>(face.control_first),
                                                       static_cast<std::size_t>(face.control_count)));
            if (c.straight || asks_far(c)) {
                return;
            }
            if (!factory->InitVertexSurface(c.representative, &entry.surface)) {
                throw std::logic_error(fmt::format("face {} has no limit surface", c.representative));
            }
            entry.to_control = map_controls(entry.surface, c, entry.position);
            if (!c.fading) {
                entry.cells =
                    std::make_unique<BicubicCells>(c.corner_count == 4 ? 1 : c.corner_count, c.control_count);
            }
        });
        return entry;
    }

    const Topology& topology;
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner;
    std::optional<Factory> factory;
    std::vector<ClassSurface> surfaces;
    bool chaikin;
    std::unique_ptr<FarStencils> far;
};

PageMaker::PageMaker(const Mesh& mesh, const Topology& topology, Options options)
    : impl_(std::make_unique<Impl>(mesh, topology, std::clamp(options.approximation_level, 1, 10))) {}

PageMaker::~PageMaker() = default;

void PageMaker::make(const PageKey& key, float* weights) const {
    const FaceClass& c = impl_->topology.classes[static_cast<std::size_t>(key.face_class)];
    StencilEvaluator stencil(impl_->surface(key.face_class), c,
                             impl_->asks_far(c) ? impl_->far.get() : nullptr);
    const bool displaced = impl_->topology.displaced;
    const std::size_t all = page_floats(key, c.control_count, displaced);
    std::fill_n(weights, all, 0.0F);
    switch (key.kind) {
    case PageKind::vertex: {
        const SubPoint p = at_vertex(key.local, c.corner_count);
        stencil.evaluate(p.sub, p.uv, displaced ? 1 : 0);
        for (std::size_t k = 0; k < (displaced ? 3U : 1U); ++k) {
            stencil.store(k, weights + k * (all / 3), 1, 0);
        }
        break;
    }
    case PageKind::curve:
        for (int i = 0; i <= quads(key.exponent_u); ++i) {
            const double t = dyadic(key.strip_u, i, key.exponent_u);
            const SubPoint p = on_curve(key.local, key.reversed ? 1 - t : t, c.corner_count);
            stencil.evaluate(p.sub, p.uv, displaced ? 1 : 0);
            stencil.store(0, weights, curve_row, static_cast<std::size_t>(i));
            for (std::size_t k = 0; displaced && k < 2; ++k) {
                stencil.store(1 + k, weights + all / 3 + k * curve_row, std::size_t{2} * curve_row,
                              static_cast<std::size_t>(i));
            }
        }
        break;
    case PageKind::block:
    case PageKind::derivative: {
        const bool derivatives = key.kind == PageKind::derivative;
        const std::size_t row =
            all / (static_cast<std::size_t>(c.control_count) * (derivatives ? (displaced ? 5U : 2U) : 1U));
        float* const second = weights + 2 * row * static_cast<std::size_t>(c.control_count);
        std::size_t column = 0;
        for (int j = 0; j <= quads(key.exponent_v); ++j) {
            for (int i = 0; i <= quads(key.exponent_u); ++i, ++column) {
                const Uv uv{dyadic(key.strip_u, i, key.exponent_u), dyadic(key.strip_v, j, key.exponent_v)};
                stencil.evaluate(key.local, uv, derivatives ? (displaced ? 2 : 1) : 0);
                if (derivatives) {
                    stencil.store(1, weights, 2 * row, column);
                    stencil.store(2, weights + row, 2 * row, column);
                    for (std::size_t k = 0; displaced && k < 3; ++k) {
                        stencil.store(3 + k, second + k * row, 3 * row, column);
                    }
                } else {
                    stencil.store(0, weights, row, column);
                }
            }
        }
        break;
    }
    case PageKind::deviation:
        bound_deviation(stencil, key, c.control_count, weights);
        if (c.regular) {
            const std::size_t row = all / 3;
            place_regular_controls(weights + row, weights + 2 * row);
        }
        break;
    }
}

} // namespace razor
