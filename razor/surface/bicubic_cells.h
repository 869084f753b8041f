// A limit surface is one bicubic polynomial over most of a face: all of a regular one, and of any other what
// no extraordinary corner or sharp edge reaches. There its weights at any point follow from those at 16,
// which is several times as fast as OpenSubdiv's own evaluation, and no less exact (error bound:
// lagrange_sum).
//
// Faces are cut into 4 x 4 cells (each sub-face of other polygons). Whether a cell is one polynomial is asked
// of the surface itself: at 16 further points, in each quarter of a quarter, the polynomial through the first
// 16 must be what OpenSubdiv says. That is a sound question where what is not polynomial looks alike at every
// scale, as it does round extraordinary points, boundaries and infinitely sharp edges (the surface is
// self-similar there: Stam, Exact Evaluation of Catmull-Clark Subdivision Surfaces, 1998). Sharpness that
// fades out after some levels hides closer to the edge than points are: faces with such have no cells
// (FaceClass::fading).
//
// A point's weights depend on the point alone, whichever page has it: those of grids of up to 8 x 8 quads,
// and of the face's border, which curves have too, are always OpenSubdiv's; of all others, those of the cell
// that begins at or before the point.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace razor {

class BicubicCells {
public:
    using Uv = std::array<double, 2>;
    /// Weights of all controls, in double: position, d/du, d/dv, d2/du2, d2/dudv, d2/dv2.
    using Rows = std::array<std::vector<double>, 6>;
    /// The surface's own position weights, of sub-face `sub`.
    using Exact = std::function<const std::vector<double>&(int sub, Uv uv)>;

    BicubicCells(int sub_count, int control_count);

    /// The largest sum of the absolute values of the four Lagrange polynomials over a cell: weights are off
    /// by at most its square times what OpenSubdiv's are off by (its roundings: 1e-15), first and second
    /// derivatives by some tens and hundreds of times that.
    static constexpr double lagrange_sum = 2.5;

    /// Weights of one point after the other, by one thread; points of a row (of one v) are best together.
    class Reader {
    public:
        /// `cells`: null, or what must outlive this. `exact` is asked once a cell, by whoever comes first.
        Reader(BicubicCells* cells, Exact exact) : cells_(cells), exact_(std::move(exact)) {}
        /// Weights at a point of a sub-face, and their derivatives up to `order` by its coordinates; rows
        /// beyond those are left as they are. False: no cell has the point.
        bool evaluate(int sub, Uv uv, int order, Rows& rows);

    private:
        BicubicCells* cells_;
        Exact exact_;
        // Of the row at hand: sums over v alone, and their derivatives by it, up to `row_order_`.
        const void* row_cell_ = nullptr;
        double row_v_ = 0;
        int row_order_ = -1;
        std::array<std::vector<double>, 3> row_; // four sums of all controls
    };

private:
    static constexpr int side = 4;
    struct Cell {
        std::once_flag tried;
        std::vector<double> at_nodes; // row by row, of all controls; empty: not one polynomial
    };
    void fit(Cell& cell, int sub, Uv corner, const Exact& exact) const;

    std::size_t controls_;
    std::unique_ptr<Cell[]> cells_; // by sub-face, row by row
};

} // namespace razor
