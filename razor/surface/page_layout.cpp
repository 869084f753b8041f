#include "razor/surface/page_layout.h"

#include "razor/scene/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace razor {
namespace {

constexpr int largest_width = 64; // of any build

std::size_t rounded_up(std::size_t n, std::size_t step) {
    return (n + step - 1) / step * step;
}

std::size_t block_row(std::size_t vertices) {
    return rounded_up(vertices, RAZOR_WIDTH);
}

std::size_t section_floats(PageKind kind, std::size_t controls, std::size_t vertices, bool displaced) {
    switch (kind) {
    case PageKind::vertex:
        return (displaced ? 3 : 1) * rounded_up(controls, largest_width);
    case PageKind::curve:
        return (displaced ? 3 : 1) * controls * curve_row;
    case PageKind::block:
        return controls * block_row(vertices);
    case PageKind::derivative:
        return (displaced ? 5 : 2) * controls * block_row(vertices);
    case PageKind::deviation:
        return 3 * rounded_up(controls, largest_width);
    }
    throw std::logic_error("page kind out of range");
}

int sub_count(int corner_count) {
    return corner_count == 4 ? 1 : corner_count;
}

int curve_ways(int corner_count) { // edges and spokes, either way
    return 2 * (corner_count == 4 ? 4 : 2 * corner_count);
}

/// Exponents of an n-gon's sub-faces are less than their edges'.
int block_exponent(const FaceClass& c, int max_exponent) {
    return c.corner_count == 4 ? max_exponent : std::max(max_exponent - 1, 0);
}

struct Strip {
    int exponent, strip;
};
Strip strip_of(int number) { // inverse of strip_first
    if (number < 3) {
        return {number, 0};
    }
    const int log2 = static_cast<int>(std::bit_width(static_cast<unsigned>(number - 2))) - 1;
    return {log2 + 3, number - 2 - (1 << log2)};
}

struct Pair {
    int u, v;
};
Pair strips_of(int pair) {                                                      // inverse of strip_pair
    const auto larger = static_cast<int>(std::sqrt(static_cast<double>(pair))); // exact: below 2^52
    const int rest = pair - larger * larger;
    return rest > larger ? Pair{rest - larger - 1, larger} : Pair{larger, rest};
}

} // namespace

PageKey page_key(int face_class, PageKind kind, int index, int corner_count) {
    PageKey key;
    key.face_class = face_class;
    key.kind = kind;
    switch (kind) {
    case PageKind::vertex:
        key.local = index;
        if (index > corner_count) {
            throw std::logic_error("vertex page out of range");
        }
        break;
    case PageKind::curve: {
        const int ways = curve_ways(corner_count);
        const Strip u = strip_of(index / ways);
        key.exponent_u = u.exponent;
        key.strip_u = u.strip;
        key.reversed = index % 2 != 0;
        key.local = index % ways / 2;
        break;
    }
    case PageKind::block:
    case PageKind::derivative:
    case PageKind::deviation: {
        const int subs = sub_count(corner_count);
        const int pair = index / block_kinds / subs;
        const Pair strips = strips_of(pair);
        const Strip u = strip_of(strips.u), v = strip_of(strips.v);
        key.exponent_u = u.exponent;
        key.strip_u = u.strip;
        key.exponent_v = v.exponent;
        key.strip_v = v.strip;
        key.local = index / block_kinds % subs;
        break;
    }
    }
    return key;
}

std::size_t page_floats(const PageKey& key, int control_count, bool displaced) {
    const auto side = [](int exponent) {
        return static_cast<std::size_t>(std::min(block_quads, 1 << exponent)) + 1;
    };
    return section_floats(key.kind, static_cast<std::size_t>(control_count),
                          side(key.exponent_u) * side(key.exponent_v), displaced);
}

ClassRecord class_record(const FaceClass& c, int max_exponent) {
    ClassRecord record{};
    record.control_count = c.control_count;
    record.corner_count = c.corner_count;
    record.subs = sub_count(c.corner_count);
    record.curve_ways = curve_ways(c.corner_count);
    const int curves = c.corner_count + 1; // after the vertices
    const int blocks = curves + record.curve_ways * strip_first(max_exponent + 1);
    record.first[static_cast<int>(PageKind::vertex)] = 0;
    record.first[static_cast<int>(PageKind::curve)] = curves;
    record.first[static_cast<int>(PageKind::block)] = blocks;
    record.first[static_cast<int>(PageKind::derivative)] = blocks + 1;
    record.first[static_cast<int>(PageKind::deviation)] = blocks + 2;
    return record;
}

std::int64_t class_entries(const FaceClass& c, int max_exponent) {
    const std::int64_t strips = strip_first(block_exponent(c, max_exponent) + 1);
    const ClassRecord record = class_record(c, max_exponent);
    return record.first[static_cast<int>(PageKind::block)] + strips * strips * record.subs * block_kinds;
}

int largest_exponent(const Mesh& mesh, const std::vector<FaceClass>& classes) {
    for (int exponent = max_exponent_limit; exponent >= 0; --exponent) {
        std::int64_t sum = 0;
        bool fits = true;
        for (const FaceClass& c : classes) {
            const std::int64_t entries = class_entries(c, exponent);
            sum += entries;
            fits = fits && entries < most_class_entries && sum < most_mesh_entries;
        }
        if (fits) {
            return exponent;
        }
    }
    throw UserError(fmt::format(
        "mesh '{}': its {} kinds of faces need more weights than can be numbered; split the mesh, or "
        "its largest faces",
        mesh.name, classes.size()));
}

} // namespace razor
