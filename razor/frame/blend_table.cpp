#include "razor/frame/blend_table.h"

#include "razor/frame/layout.h"

#include <algorithm>

namespace razor {
namespace {

/// Which vertices of a block of 2^a x 2^b quads a pass blends (layout.h).
void fill_pass(int a, int b, int pass, std::int32_t* out) {
    const int quads_u = 1 << a, quads_v = 1 << b, width = quads_u + 1;
    const int step = 1 << (block_log2 - 1 - pass);
    auto inside = [](int i, int quads) { return i != 0 && i != quads; };
    std::int32_t count = 0;
    std::int32_t* list = out + line_bytes / 4;
    for (int j = 0; j <= quads_v; ++j)
        for (int i = 0; i <= quads_u; ++i) {
            // Ends of rows and columns belong to every level.
            const bool at_u = !inside(i, quads_u) || i % step == 0,
                       at_v = !inside(j, quads_v) || j % step == 0;
            const bool odd_u = inside(i, quads_u) && i / step % 2 != 0;
            const bool odd_v = inside(j, quads_v) && j / step % 2 != 0;
            if (!at_u || !at_v || (!odd_u && !odd_v))
                continue;
            const int along = (odd_u ? step : 0) + (odd_v ? step * width : 0);
            const int vertex = j * width + i;
            list[count] = vertex;
            list[pass_vertices + count] = vertex - along;
            list[2 * pass_vertices + count] = vertex + along;
            list[3 * pass_vertices + count] = j == 0         ? 0
                                              : j == quads_v ? 2
                                              : i == quads_u ? 1
                                              : i == 0       ? 3
                                                             : -1;
            ++count;
        }
    *out = count;
}

/// What a pass, as filled, does to vertices as they lie (layout.h).
void fill_rows(int a, int step, const std::int32_t* pass, std::int32_t* out) {
    const int width = (1 << a) + 1;
    std::fill_n(out, row_vertices, blend_none);
    std::fill_n(out + row_vertices, row_vertices, -1);
    const std::int32_t* list = pass + line_bytes / 4;
    for (int n = 0; n < *pass; ++n) {
        const int vertex = list[n];
        const int along = vertex - list[pass_vertices + n];
        out[vertex] = along == step ? blend_along_u : along == step * width ? blend_along_v : blend_diagonal;
        out[row_vertices + vertex] = list[3 * pass_vertices + n];
    }
}

} // namespace

void fill_blend_table(std::int32_t* table) {
    for (int a = 0; a <= block_log2; ++a)
        for (int b = 0; b <= block_log2; ++b) {
            for (int pass = 0; pass < blend_passes; ++pass) {
                std::int32_t* list = table + blend_pass(a, b, pass);
                fill_pass(a, b, pass, list);
                fill_rows(a, 1 << (block_log2 - 1 - pass), list, table + blend_rows(a, b, pass));
            }
        }
}

} // namespace razor
