#include "razor/check/dump.h"

#include <algorithm>

namespace razor::check {

Point BlockView::vertex(int i) const {
    const float* x = words + block_header_words;
    return {x[i], x[i + header->stride], x[i + 2 * header->stride]};
}

int BlockView::segments(int side) const {
    return side % 2 == 0 ? header->quads_u : header->quads_v;
}

Point BlockView::along(int side, int i) const {
    int width = header->quads_u + 1;
    switch (side) {
    case 0:
        return vertex(i);
    case 1:
        return vertex(i * width + header->quads_u);
    case 2:
        return vertex(width * header->quads_v + i);
    default:
        return vertex(i * width);
    }
}

FlatEdge BlockView::ancestor(int side, int i) const {
    int hang = header->hang[side];
    int length = 1 << hang;
    if (length > segments(side)) {
        const float* p = words + header->ancestors_at + 6 * side;
        return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, hang};
    }
    int first = i / length * length;
    return {along(side, first), along(side, first + length), hang};
}

const InstanceRecord& instance_of(Frame& frame, int patch) {
    const FrameHeader& h = frame.header();
    return h.instances.get()[h.cluster_instance.get()[patch / refit_patches]];
}

const PatchRecord& patch_record(Frame& frame, int patch) {
    const InstanceRecord& instance = instance_of(frame, patch);
    return frame.header().patches.get()[instance.first_record + (patch - instance.first_patch)];
}

BlockView block_at(Frame& frame, int line) {
    const Line* at = frame.header().grids.get() + line;
    return {reinterpret_cast<const BlockHeader*>(at), reinterpret_cast<const float*>(at)};
}

std::vector<BlockView> known_blocks_of(Frame& frame, int patch, int tree, int level) {
    const FrameHeader& h = frame.header();
    const OpenPatch& open = h.trees.get()[tree].patches.get()[patch];
    std::vector<BlockView> blocks;
    if (open.state.word != ready)
        return blocks;
    std::vector<BlockView> left{block_at(frame, open.root)};
    while (!left.empty()) {
        BlockView b = left.back();
        left.pop_back();
        if (b.header->level == level)
            blocks.push_back(b);
        if (b.header->level <= level || b.header->children.word != ready)
            continue;
        int children = children_in(b.header->child_shape);
        for (int i = 0; i < children; ++i)
            left.push_back(block_at(frame, b.header->child_line + i * lines_between(b.header->child_shape)));
    }
    std::sort(blocks.begin(), blocks.end(),
              [](const BlockView& a, const BlockView& b) { return a.header->number < b.header->number; });
    return blocks;
}

std::vector<BlockView> blocks_of(Frame& frame, int patch, int tree, int level) {
    std::vector<BlockView> blocks = known_blocks_of(frame, patch, tree, level);
    std::erase_if(blocks, [](const BlockView& b) { return b.header->made.word != ready; });
    return blocks;
}

namespace {

FlatEdge reversed(const FlatEdge& e) {
    return {e.to, e.from, e.hang};
}

/// Both triangles of quad (i, j): (00, 10, 11) and (00, 11, 01).
void add_quad(const BlockView& b, int i, int j, std::vector<Triangle>& out) {
    const BlockHeader& h = *b.header;
    int width = h.quads_u + 1;
    Point p00 = b.vertex(j * width + i);
    Point p10 = b.vertex(j * width + i + 1);
    Point p01 = b.vertex((j + 1) * width + i);
    Point p11 = b.vertex((j + 1) * width + i + 1);
    FlatEdge bottom = j == 0 ? b.ancestor(0, i) : FlatEdge{p00, p10, 0};
    FlatEdge right = i == h.quads_u - 1 ? b.ancestor(1, j) : FlatEdge{p10, p11, 0};
    FlatEdge top = j == h.quads_v - 1 ? b.ancestor(2, i) : FlatEdge{p01, p11, 0};
    FlatEdge left = i == 0 ? b.ancestor(3, j) : FlatEdge{p00, p01, 0};
    FlatEdge diagonal{p00, p11, 0};
    int number = h.number * 128 + (j * block_quads + i) * 2;
    out.push_back({h.patch, number, h.instance, {p00, p10, p11}, {bottom, right, reversed(diagonal)}});
    if (triangles_in(h.triangles) > 1)
        out.push_back(
            {h.patch, number + 1, h.instance, {p00, p11, p01}, {diagonal, reversed(top), reversed(left)}});
}

} // namespace

void add_triangles(const BlockView& block, std::vector<Triangle>& out) {
    for (int j = 0; j < block.header->quads_v; ++j)
        for (int i = 0; i < block.header->quads_u; ++i)
            add_quad(block, i, j, out);
}

std::vector<Triangle> triangles_of(Frame& frame, int tree) {
    std::vector<Triangle> triangles;
    for (int patch = 0; patch < frame.header().patch_count; ++patch)
        for (const BlockView& b : blocks_of(frame, patch, tree))
            add_triangles(b, triangles);
    return triangles;
}

} // namespace razor::check
