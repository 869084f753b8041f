// Pages of limit-surface weights, made by OpenSubdiv's Bfr on request.
#pragma once

#include "razor/surface/topology.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace razor {

/// What a page holds (razor/frame/layout.h): its section, and the index within the section taken apart.
struct PageKey {
    int face_class = 0;
    PageKind kind = PageKind::block;
    int local = 0;         // vertex: corner or corner_count (centre). curve: local curve. block, derivative: sub
    bool reversed = false; // curve
    int exponent_u = 0, strip_u = 0; // strip: chunk or block column within its exponent
    int exponent_v = 0, strip_v = 0;
};

/// Inverse of the index formulas of PageKind for a class of `corner_count` corners and `strips` strips.
PageKey page_key(int face_class, PageKind kind, int index, int corner_count, int strips);

/// Floats that follow a page's header line, and the largest such number over all keys of a kind (the section's stride).
std::size_t page_floats(const PageKey& key, int control_count);
std::size_t largest_page_floats(PageKind kind, int control_count);

class PageMaker {
  public:
    struct Options {
        int approximation_level = 4; // Bfr's smooth and sharp level; the README states the error it leaves
    };
    /// Keeps references to both arguments.
    PageMaker(const Mesh& mesh, const Topology& topology, Options options);
    PageMaker(const Mesh& mesh, const Topology& topology) : PageMaker(mesh, topology, Options{}) {}
    ~PageMaker();
    PageMaker(const PageMaker&) = delete;
    PageMaker& operator=(const PageMaker&) = delete;

    /// Writes page_floats(key, ...) weights. Any thread, any order: the weights depend on the key alone.
    void make(const PageKey& key, float* weights) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace razor
