#include "razor/surface/page_layout.h"

#include "razor/scene/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>

namespace razor {
namespace {

constexpr int largest_width = 64; // of any build
constexpr std::size_t line_floats = line_bytes / sizeof(float);

std::size_t rounded_up(std::size_t n, std::size_t step) {
    return (n + step - 1) / step * step;
}

std::size_t block_row(std::size_t vertices) {
    return rounded_up(vertices, RAZOR_WIDTH);
}

std::size_t section_floats(PageKind kind, std::size_t controls, std::size_t vertices) {
    switch (kind) {
    case PageKind::vertex:
        return rounded_up(controls, largest_width);
    case PageKind::curve:
        return controls * curve_row;
    case PageKind::block:
        return controls * block_row(vertices);
    case PageKind::derivative:
        return 2 * controls * block_row(vertices);
    case PageKind::deviation:
        return rounded_up(controls, largest_width);
    }
    throw std::logic_error("page kind out of range");
}

struct Section {
    std::int64_t stride, pages; // lines, count
};

std::array<Section, page_kinds> class_sections(const FaceClass& c, int max_exponent) {
    const std::int64_t strips = strip_first(max_exponent + 1);
    const bool quad = c.corner_count == 4;
    const std::int64_t curves = quad ? 4 : 2 * c.corner_count;
    const std::int64_t blocks = (quad ? 1 : c.corner_count) * strips * strips;
    const std::array<std::int64_t, page_kinds> pages{c.corner_count + 1, curves * 2 * strips, blocks, blocks,
                                                     blocks};
    std::array<Section, page_kinds> sections{};
    for (std::size_t k = 0; k < page_kinds; ++k) {
        const std::size_t floats = largest_page_floats(static_cast<PageKind>(k), c.control_count);
        sections[k] = {1 + static_cast<std::int64_t>(rounded_up(floats, line_floats) / line_floats),
                       pages[k]};
    }
    return sections;
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

} // namespace

PageKey page_key(int face_class, PageKind kind, int index, int corner_count, int strips) {
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
        const Strip u = strip_of(index % strips);
        key.exponent_u = u.exponent;
        key.strip_u = u.strip;
        key.reversed = index / strips % 2 != 0;
        key.local = index / strips / 2;
        break;
    }
    case PageKind::block:
    case PageKind::derivative:
    case PageKind::deviation: {
        const Strip v = strip_of(index % strips), u = strip_of(index / strips % strips);
        key.exponent_u = u.exponent;
        key.strip_u = u.strip;
        key.exponent_v = v.exponent;
        key.strip_v = v.strip;
        key.local = index / strips / strips;
        break;
    }
    }
    return key;
}

std::size_t page_floats(const PageKey& key, int control_count) {
    const auto side = [](int exponent) {
        return static_cast<std::size_t>(std::min(block_quads, 1 << exponent)) + 1;
    };
    return section_floats(key.kind, static_cast<std::size_t>(control_count),
                          side(key.exponent_u) * side(key.exponent_v));
}

std::size_t largest_page_floats(PageKind kind, int control_count) {
    return section_floats(kind, static_cast<std::size_t>(control_count), block_vertices);
}

ClassRecord class_record(const FaceClass& face_class, int max_exponent) {
    ClassRecord record{};
    record.control_count = face_class.control_count;
    record.corner_count = face_class.corner_count;
    record.strips = strip_first(max_exponent + 1);
    std::int64_t next = 0;
    const std::array<Section, page_kinds> sections = class_sections(face_class, max_exponent);
    for (std::size_t k = 0; k < page_kinds; ++k) {
        record.first[k] = static_cast<std::int32_t>(next);
        record.stride[k] = static_cast<std::int32_t>(sections[k].stride);
        next += sections[k].stride * sections[k].pages;
    }
    return record;
}

std::int64_t class_lines(const FaceClass& face_class, int max_exponent) {
    std::int64_t lines = 0;
    for (const Section& section : class_sections(face_class, max_exponent)) {
        lines += section.stride * section.pages;
    }
    return lines;
}

int largest_exponent(const Mesh& mesh, const std::vector<FaceClass>& classes) {
    for (int exponent = max_exponent_limit; exponent >= 0; --exponent) {
        std::int64_t sum = 0;
        bool fits = true;
        for (const FaceClass& c : classes) {
            const std::int64_t lines = class_lines(c, exponent);
            sum += lines;
            fits = fits && lines < class_page_lines && sum < mesh_page_lines;
        }
        if (fits) {
            return exponent;
        }
    }
    throw UserError(fmt::format(
        "mesh '{}': its {} kinds of faces need more weights than can be addressed; split the mesh, or "
        "its largest faces",
        mesh.name, classes.size()));
}

} // namespace razor
