// Pages of limit-surface weights, made by OpenSubdiv's Bfr on request.
#pragma once

#include "razor/surface/topology.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace razor {

/// What a page holds (razor/frame/layout.h): its section, and the index within the section taken apart.
struct PageKey {
    int face_class = 0;
    PageKind kind = PageKind::block;
    int local = 0; // vertex: corner or corner_count (centre). curve: local curve. block, derivative: sub
    bool reversed = false;           // curve
    int exponent_u = 0, strip_u = 0; // strip: chunk or block column within its exponent
    int exponent_v = 0, strip_v = 0;
};

/// Inverse of the index formulas of PageKind for a class of `corner_count` corners.
PageKey page_key(int face_class, PageKind kind, int index, int corner_count);

/// Floats of a page.
///   - vertex: one row of control_count weights, zero-padded to a multiple of 64 (any width can read it)
///   - curve: control_count rows of curve_row weights, the first 1 + min(8, 2^N) used, the rest zero
///   - block: control_count rows of (nu+1)(nv+1) weights, nu = min(8, 2^Nu), zero-padded to a multiple of
///     RAZOR_WIDTH
///   - derivative: as block, two rows a control point
///   - deviation: three rows of control_count numbers, zero-padded to a multiple of 64: bounds; and, of a
///     regular face, its control points' places along u and v (zero of others)
/// `displaced`: of a mesh that is, whose pages hold more (razor/frame/layout.h).
std::size_t page_floats(const PageKey& key, int control_count, bool displaced = false);

/// How a class's pages are numbered: vertices, then curves, then blocks. `entries` and `lines` are left to
/// the caller.
ClassRecord class_record(const FaceClass& face_class, int max_exponent);

/// Entries of all pages of a class: those of the next class may follow.
std::int64_t class_entries(const FaceClass& face_class, int max_exponent);

class PageMaker {
public:
    struct Options {
        /// Refinement levels to which extraordinary points and sharp features are isolated before
        /// OpenSubdiv approximates; 1 to 10 (its patches cannot go deeper: more would corrupt memory).
        /// At 10 semi-sharp features (below 10) have become smooth, and points at multiples of 2^-10 of a
        /// quad (2^-9 of a sub-face) are corners of refined patches, where limits are exact. Finer grids have
        /// points between those: in the last patches beside extraordinary points they are off by up to 2e-6
        /// of the cage's size (cube), 3e-5 (valence 5), 1e-3 (valence 30). At 4 the corners are off by up to
        /// 5e-4 (cube), 1e-2 (valence 64), 4e-3 (sharpness 9).
        int approximation_level = 10;
    };
    /// Keeps a reference to `topology` and copies what it needs of `mesh`.
    PageMaker(const Mesh& mesh, const Topology& topology, Options options);
    PageMaker(const Mesh& mesh, const Topology& topology) : PageMaker(mesh, topology, Options{}) {}
    ~PageMaker();
    PageMaker(const PageMaker&) = delete;
    PageMaker& operator=(const PageMaker&) = delete;

    /// Writes page_floats(key, ...) weights. Any thread, any order: the weights depend on the key alone.
    /// Throws std::logic_error if OpenSubdiv uses a control point that the topology does not list.
    void make(const PageKey& key, float* weights) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace razor
