#include "razor/surface/bicubic_cells.h"

#include <algorithm>
#include <cmath>

namespace razor {
namespace {

/// Within a cell: inside it, as its borders may be another polynomial's too, and near its ends, so that
/// little is extrapolated.
constexpr std::array<double, 4> nodes{1.0 / 16, 5.0 / 16, 11.0 / 16, 15.0 / 16};
constexpr std::array<double, 4> checks{3.0 / 16, 7.0 / 16, 9.0 / 16, 13.0 / 16};
/// Weights are about 1 at most. Roundings come to a hundredth of that; other polynomials are further off.
constexpr double same = 1e-12;

/// The polynomials of degree 3 that are 1 at one node and 0 at the others.
struct Lagrange {
    std::array<double, 4> value{};
    std::array<std::array<double, 3>, 4> roots{};

    constexpr Lagrange() {
        for (std::size_t k = 0; k < 4; ++k) {
            double across = 1;
            for (std::size_t j = 0, n = 0; j < 4; ++j) {
                if (j != k) {
                    roots[k][n++] = nodes[j];
                    across *= nodes[k] - nodes[j];
                }
            }
            value[k] = 1 / across;
        }
    }
    /// All four at t, or their first or second derivatives.
    std::array<double, 4> at(double t, int order) const {
        std::array<double, 4> out;
        for (std::size_t k = 0; k < 4; ++k) {
            const double a = t - roots[k][0], b = t - roots[k][1], c = t - roots[k][2];
            out[k] = value[k] * (order == 0   ? a * b * c
                                 : order == 1 ? a * b + a * c + b * c
                                              : 2 * (a + b + c));
        }
        return out;
    }
};
constexpr Lagrange lagrange;

/// out[k] = scale * (the sum over i of weight[i] * in[i * stride + k]).
void combine(const std::array<double, 4>& weight, const double* in, std::size_t stride, double scale,
             double* out, std::size_t n) {
    const double w0 = scale * weight[0], w1 = scale * weight[1], w2 = scale * weight[2],
                 w3 = scale * weight[3];
    const double *a = in, *b = a + stride, *c = b + stride, *d = c + stride;
    for (std::size_t k = 0; k < n; ++k) {
        out[k] = w0 * a[k] + w1 * b[k] + w2 * c[k] + w3 * d[k];
    }
}

bool is_end(double t) {
    return t == 0 || t == 1;
}
bool is_eighth(double t) {
    return t * 8 == std::floor(t * 8);
}

} // namespace

BicubicCells::BicubicCells(int sub_count, int control_count)
    : controls_(static_cast<std::size_t>(control_count)),
      cells_(std::make_unique<Cell[]>(static_cast<std::size_t>(sub_count * side * side))) {}

void BicubicCells::fit(Cell& cell, int sub, Uv corner, const Exact& exact) const {
    const auto at = [&](double u, double v) -> const std::vector<double>& {
        return exact(sub, {corner[0] + u / side, corner[1] + v / side});
    };
    std::vector<double> values;
    values.reserve(nodes.size() * nodes.size() * controls_);
    for (const double v : nodes) {
        for (const double u : nodes) {
            const std::vector<double>& weights = at(u, v);
            values.insert(values.end(), weights.begin(), weights.end());
        }
    }
    std::vector<double> row(4 * controls_), fitted(controls_);
    for (const double v : checks) {
        combine(lagrange.at(v, 0), values.data(), 4 * controls_, 1, row.data(), row.size());
        for (const double u : checks) {
            combine(lagrange.at(u, 0), row.data(), controls_, 1, fitted.data(), controls_);
            const std::vector<double>& weights = at(u, v);
            for (std::size_t k = 0; k < controls_; ++k) {
                if (!(std::abs(fitted[k] - weights[k]) <= same)) {
                    return;
                }
            }
        }
    }
    cell.at_nodes = std::move(values);
}

bool BicubicCells::Reader::evaluate(int sub, Uv uv, int order, Rows& rows) {
    if (cells_ == nullptr || is_end(uv[0]) || is_end(uv[1]) || (is_eighth(uv[0]) && is_eighth(uv[1]))) {
        return false;
    }
    const int column = static_cast<int>(uv[0] * side), row = static_cast<int>(uv[1] * side);
    Cell& cell = cells_->cells_[static_cast<std::size_t>((sub * side + row) * side + column)];
    const Uv corner{static_cast<double>(column) / side, static_cast<double>(row) / side};
    std::call_once(cell.tried, [&] { cells_->fit(cell, sub, corner, exact_); });
    if (cell.at_nodes.empty()) {
        return false;
    }
    constexpr std::array<double, 3> scales{1, side, side * side};
    const std::size_t n = cells_->controls_;
    if (row_cell_ != &cell || row_v_ != uv[1] || row_order_ < order) {
        row_cell_ = &cell;
        row_v_ = uv[1];
        row_order_ = order;
        for (int by_v = 0; by_v <= order; ++by_v) {
            std::vector<double>& sums = row_[static_cast<std::size_t>(by_v)];
            sums.resize(4 * n);
            combine(lagrange.at((uv[1] - corner[1]) * side, by_v), cell.at_nodes.data(), 4 * n,
                    scales[static_cast<std::size_t>(by_v)], sums.data(), 4 * n);
        }
    }
    std::size_t r = 0;
    for (int of = 0; of <= order; ++of) {
        for (int by_v = 0; by_v <= of; ++by_v, ++r) {
            const int by_u = of - by_v;
            combine(lagrange.at((uv[0] - corner[0]) * side, by_u),
                    row_[static_cast<std::size_t>(by_v)].data(), n, scales[static_cast<std::size_t>(by_u)],
                    rows[r].data(), n);
        }
    }
    return true;
}

} // namespace razor
