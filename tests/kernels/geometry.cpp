// Tessellated blocks: vertices where the surface is, the same bits from every neighbour, no T-junction.
#include "razor/check/dump.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/reference_surface.h"
#include "tests/kernels/targets.h"

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace razor::test {
namespace {

double distance(const Point& p, const glm::dvec3& q) {
    return std::max({std::abs(p[0] - q.x), std::abs(p[1] - q.y), std::abs(p[2] - q.z)});
}

/// One patch's grid of vertices, and its blocks.
struct Grid {
    int nu = 0, nv = 0, columns = 1;
    std::vector<BlockView> blocks;

    const BlockView& block(int column, int row) const {
        return blocks[static_cast<std::size_t>(row * columns + column)];
    }
    int length(int side) const { return 1 << (side % 2 == 0 ? nu : nv); }
    /// Block at segment i of a side, and the segment in the block.
    std::pair<const BlockView*, int> at_side(int side, int i) const {
        int strip = std::min(i >> block_log2, std::max(length(side) >> block_log2, 1) - 1);
        int rows = static_cast<int>(blocks.size()) / columns;
        const BlockView* b = side == 0   ? &block(strip, 0)
                             : side == 1 ? &block(columns - 1, strip)
                             : side == 2 ? &block(strip, rows - 1)
                                         : &block(0, strip);
        return {b, i - strip * block_quads};
    }
};

class Geometry : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        scene_ = named_scene(GetParam());
        if (!scene_)
            GTEST_SKIP() << "the shared scenes are not there";
        frame_ = std::make_unique<Frame>(scene_->scene, FrameOptions{});
        frame_->build_all(*native_targets().back());
        surface_ = std::make_unique<ReferenceSurface>(*frame_, scene_->scene.meshes.front());
    }
    int patch_count() const { return frame_->header().patch_count; }
    const PatchRecord& patch(int i) const { return frame_->header().patches.get()[i]; }
    Grid grid(int i) const {
        Grid g;
        std::array<int, 2> n = surface_->grid(patch(i));
        g.nu = n[0];
        g.nv = n[1];
        g.columns = std::max(1 << g.nu >> block_log2, 1);
        g.blocks = blocks_of(*frame_, i);
        return g;
    }

    std::optional<NamedScene> scene_;
    std::unique_ptr<Frame> frame_;
    std::unique_ptr<ReferenceSurface> surface_;
};

TEST_P(Geometry, BlocksHaveTheirShape) {
    for (int i = 0; i < patch_count(); ++i) {
        Grid g = grid(i);
        int rows = std::max(1 << g.nv >> block_log2, 1);
        ASSERT_EQ(static_cast<int>(g.blocks.size()), g.columns * rows) << "patch " << i;
        for (int b = 0; b < static_cast<int>(g.blocks.size()); ++b) {
            const BlockHeader& h = *g.blocks[static_cast<std::size_t>(b)].header;
            EXPECT_EQ(h.patch, i);
            EXPECT_EQ(h.number, b);
            EXPECT_EQ(h.quads_u, 1 << std::min(g.nu, block_log2));
            EXPECT_EQ(h.quads_v, 1 << std::min(g.nv, block_log2));
            EXPECT_EQ(h.triangles, patch(i).kind == PatchKind::flat_triangle ? 1 : 2);
            EXPECT_EQ(h.stride, (h.quads_u + 1) * (h.quads_v + 1));
        }
    }
}

TEST_P(Geometry, InnerVerticesLieOnTheSurface) {
    for (int i = 0; i < patch_count(); ++i) {
        const PatchRecord& p = patch(i);
        if (p.kind >= PatchKind::flat_quad)
            continue;
        Grid g = grid(i);
        for (const BlockView& b : g.blocks) {
            int column = b.header->number % g.columns * block_quads;
            int row = b.header->number / g.columns * block_quads;
            for (int v = 0; v < b.header->stride; ++v) {
                int u_at = column + v % (b.header->quads_u + 1);
                int v_at = row + v / (b.header->quads_u + 1);
                bool border = u_at == 0 || u_at == 1 << g.nu || v_at == 0 || v_at == 1 << g.nv;
                if (border)
                    continue;
                ASSERT_LE(distance(b.vertex(v), surface_->grid_point(p, u_at, v_at)), surface_->rounding())
                    << "patch " << i << " vertex " << u_at << ' ' << v_at;
            }
        }
    }
}

TEST_P(Geometry, FlatPatchesAreTheirCorners) {
    for (int i = 0; i < patch_count(); ++i) {
        if (patch(i).kind < PatchKind::flat_quad)
            continue;
        const float* points = frame_->header().points.get();
        constexpr std::array<int, 4> corner_of_vertex{0, 1, 3, 2};
        for (int v = 0; v < 4; ++v) {
            const float* p =
                points + std::ptrdiff_t{3} * patch(i).corner[corner_of_vertex[static_cast<std::size_t>(v)]];
            EXPECT_EQ(blocks_of(*frame_, i).front().vertex(v), (Point{p[0], p[1], p[2]}));
        }
    }
}

TEST_P(Geometry, BlocksOfAPatchShareTheirBorders) {
    for (int i = 0; i < patch_count(); ++i) {
        Grid g = grid(i);
        for (const BlockView& b : g.blocks) {
            int column = b.header->number % g.columns;
            int row = b.header->number / g.columns;
            int rows = static_cast<int>(g.blocks.size()) / g.columns;
            if (column + 1 < g.columns) {
                EXPECT_EQ(b.header->hang[1], 0);
                for (int k = 0; k <= b.header->quads_v; ++k)
                    ASSERT_EQ(b.along(1, k), g.block(column + 1, row).along(3, k)) << "patch " << i;
            }
            if (row + 1 < rows) {
                EXPECT_EQ(b.header->hang[2], 0);
                for (int k = 0; k <= b.header->quads_u; ++k)
                    ASSERT_EQ(b.along(2, k), g.block(column, row + 1).along(0, k)) << "patch " << i;
            }
        }
    }
}

/// Real vertices of a curve lie where its owner says and are the same bits in every patch; hanging ones lie
/// on the flat edge between two real ones; and that very edge, bit for bit, decides about every sub-edge.
TEST_P(Geometry, NeighboursAgreeBitForBit) {
    std::map<std::pair<int, int>, Point> real;     // (curve, number)
    std::map<std::pair<int, int>, Point> anywhere; // (curve, numerator over 2^20)
    std::map<std::pair<int, int>, Point> corners;  // (kind, number)
    int hanging = 0;
    for (int pass = 0; pass < 2; ++pass) {
        for (int i = 0; i < patch_count(); ++i) {
            const PatchRecord& p = patch(i);
            if (p.kind >= PatchKind::flat_quad)
                continue;
            Grid g = grid(i);
            for (int s = 0; s < 4; ++s) {
                int curve = p.side_curve[s];
                bool reversed = (p.side_flags[s] & side_reversed) != 0;
                int n = (s % 2 == 0 ? g.nu : g.nv) + ((p.side_flags[s] & side_half) != 0 ? 1 : 0);
                int hang = n - surface_->flat_exponent(curve);
                ASSERT_GE(hang, 0);
                for (int k = 0; k <= g.length(s); ++k) {
                    auto [b, in_block] = g.at_side(s, k);
                    Point here = b->along(s, in_block);
                    int along = reversed ? (1 << n) - k : k;
                    if (pass == 0) {
                        auto [same, first] = anywhere.try_emplace({curve, along << (20 - n)}, here);
                        ASSERT_EQ(same->second, here) << "patch " << i << " side " << s << " vertex " << k;
                        if (along % (1 << hang) == 0) {
                            real[{curve, along >> hang}] = here;
                            if (first) {
                                ASSERT_LE(distance(here, surface_->curve_point(curve, along >> hang)),
                                          2 * surface_->rounding());
                            }
                        }
                        if (k == 0) {
                            constexpr std::array<int, 4> start{0, 1, 3, 0};
                            int corner = start[static_cast<std::size_t>(s)];
                            bool part = (p.side_flags[0] & side_half) != 0;
                            int kind = part ? corner % 2 + (corner == 2 ? 2 : 0) : 0;
                            auto [other, is_new] = corners.try_emplace({kind, p.corner[corner]}, here);
                            ASSERT_EQ(other->second, here) << "patch " << i << " corner " << corner;
                        }
                        continue;
                    }
                    if (along % (1 << hang) != 0) {
                        ++hanging;
                        const Point& a = real.at({curve, along >> hang});
                        const Point& z = real.at({curve, (along >> hang) + 1});
                        double f = std::ldexp(along % (1 << hang), -hang);
                        glm::dvec3 on =
                            glm::mix(glm::dvec3(a[0], a[1], a[2]), glm::dvec3(z[0], z[1], z[2]), f);
                        ASSERT_LE(distance(here, on), 3 * 6e-8 * surface_->largest());
                    }
                    if (k == g.length(s))
                        continue;
                    auto [block, segment] = g.at_side(s, k);
                    ASSERT_EQ(block->header->hang[s], hang);
                    ASSERT_TRUE(hang == 0 || block->header->hangs != 0);
                    FlatEdge e = block->ancestor(s, segment);
                    int first = (reversed ? along - 1 : along) >> hang;
                    Point from = real.at({curve, first});
                    Point to = real.at({curve, first + 1});
                    if (reversed)
                        std::swap(from, to);
                    ASSERT_EQ(e.from, from) << "patch " << i << " side " << s << " segment " << k;
                    ASSERT_EQ(e.to, to) << "patch " << i << " side " << s << " segment " << k;
                }
            }
        }
    }
    RecordProperty("hanging_vertices", hanging);
}

TEST_P(Geometry, BoxesHoldTheirContents) {
    const FrameHeader& h = frame_->header();
    const InstanceRecord& instance = h.instances.get()[0];
    ASSERT_EQ(instance.moved, 0);
    const GraphNodeRecord& root = h.graph.get()[0];
    for (int i = 0; i < patch_count(); ++i)
        for (const BlockView& b : blocks_of(*frame_, i)) {
            const BlockHeader& block = *b.header;
            for (std::size_t k = 0; k < 3; ++k) {
                float low = 3e38F;
                float high = -3e38F;
                for (int v = 0; v < block.stride; ++v) {
                    float x = b.vertex(v)[k];
                    ASSERT_TRUE(std::isfinite(x));
                    low = std::min(low, x);
                    high = std::max(high, x);
                    if (block.cells_at == 0)
                        continue;
                    // The vertex may be in up to four cells: the one above and to the right of it will do.
                    int cells_u = (block.quads_u + 1) / 2;
                    int cells_v = (block.quads_v + 1) / 2;
                    int column = std::min(v % (block.quads_u + 1) / 2, cells_u - 1);
                    int row = std::min(v / (block.quads_u + 1) / 2, cells_v - 1);
                    const float* cell = b.words + block.cells_at + row * cells_u + column;
                    ASSERT_LE(cell[static_cast<int>(k) * cell_boxes], x);
                    ASSERT_GE(cell[static_cast<int>(k + 3) * cell_boxes], x);
                }
                if (block.deviation < 0) {
                    ASSERT_LE(block.box_low[k], low) << "announced";
                    ASSERT_GE(block.box_high[k], high) << "announced";
                } else {
                    ASSERT_EQ(block.box_low[k], low);
                    ASSERT_EQ(block.box_high[k], high);
                }
                const int cluster = i / refit_patches;
                const float* box =
                    h.cluster_boxes.get() + cluster + static_cast<std::ptrdiff_t>(k) * h.clusters_stride;
                ASSERT_LE(box[0], low) << "patch " << i;
                ASSERT_GE(box[std::ptrdiff_t{3} * h.clusters_stride], high) << "patch " << i;
                ASSERT_LE(root.low[k], low + instance.origin[k]);
                ASSERT_GE(root.high[k], high + instance.origin[k]);
            }
        }
}

/// Blocks that were announced had a box and corners before they had vertices: the box is in their parent's
/// and not much wider than what it has to hold, the corners are where the vertices came to lie, bit for bit.
TEST_P(Geometry, AnnouncedBlocksAreWhatTheyWereSaidToBe) {
    int announced = 0;
    double slack = 0;
    for (int i = 0; i < patch_count(); ++i) {
        int level = block_at(*frame_, frame_->header().trees.get()[0].patches.get()[i].root).header->level;
        for (; level >= 0; --level)
            for (const BlockView& b : blocks_of(*frame_, i, 0, level)) {
                const BlockHeader& h = *b.header;
                if (h.deviation >= 0)
                    continue;
                ++announced;
                ASSERT_GT(h.corners_at, corners_lie_in_vertices);
                const BlockHeader& parent = *block_at(*frame_, h.parent).header;
                const int corners[4] = {0, h.quads_u, h.stride - 1, h.stride - 1 - h.quads_u};
                for (int c = 0; c < 4; ++c)
                    for (std::size_t k = 0; k < 3; ++k)
                        ASSERT_EQ(b.words[h.corners_at + 3 * c + static_cast<int>(k)],
                                  b.vertex(corners[c])[k])
                            << "patch " << i << ", level " << level << ", corner " << c;
                double size = 0, own = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    ASSERT_GE(h.box_low[k], parent.box_low[k]);
                    ASSERT_LE(h.box_high[k], parent.box_high[k]);
                    float low = 3e38F, high = -3e38F;
                    for (int v = 0; v < h.stride; ++v) {
                        low = std::min(low, b.vertex(v)[k]);
                        high = std::max(high, b.vertex(v)[k]);
                    }
                    size = std::max(size, double{h.box_high[k]} - h.box_low[k]);
                    own = std::max(own, double{high} - low);
                }
                slack += size / own - 1;
            }
    }
    RecordProperty("announced", announced);
    if (GetParam() == "torus_stretched" || GetParam() == "bevelled_slab" || GetParam() == "tapered") {
        EXPECT_GT(announced, 50);
    }
    if (announced > 0) {
        EXPECT_LT(slack / announced, 0.3);
    }
}

/// What can move a block's vertices lies in one box: its own, and the ends of the edges that its sides hang
/// from, but nothing that only other blocks of the patch hang from.
TEST_P(Geometry, BoxesOfAncestorsHoldTheBlocksOwn) {
    int inner = 0;
    for (int i = 0; i < patch_count(); ++i) {
        const int coarsest =
            block_at(*frame_, frame_->header().trees.get()[0].patches.get()[i].root).header->level;
        for (int level = 0; level <= coarsest; ++level)
            for (const BlockView& b : blocks_of(*frame_, i, 0, level)) {
                if (b.header->ancestors_at == 0)
                    continue;
                Point low, high;
                for (std::size_t k = 0; k < 3; ++k) {
                    low[k] = b.header->box_low[k];
                    high[k] = b.header->box_high[k];
                }
                bool hangs = false;
                for (int s = 0; s < 4; ++s) {
                    if (1 << b.header->hang[s] <= b.segments(s))
                        continue;
                    hangs = true;
                    const FlatEdge e = b.ancestor(s, 0);
                    for (std::size_t k = 0; k < 3; ++k) {
                        low[k] = std::min({low[k], e.from[k], e.to[k]});
                        high[k] = std::max({high[k], e.from[k], e.to[k]});
                    }
                }
                inner += hangs ? 0 : 1;
                const float* box = b.words + b.header->ancestors_at + ancestor_box;
                for (std::size_t k = 0; k < 3; ++k) {
                    ASSERT_EQ(box[k], low[k]) << "patch " << i << ", level " << level;
                    ASSERT_EQ(box[k + 3], high[k]) << "patch " << i << ", level " << level;
                }
            }
    }
    RecordProperty("inner_blocks", inner);
    if (GetParam() == "tapered") {
        EXPECT_GT(inner, 0);
    }
}

/// A block's box holds every vertex of all finer levels under it, by how much those may stray from its
/// triangles.
TEST_P(Geometry, BoxesHoldAllFinerVertices) {
    int coarse = 0;
    for (int i = 0; i < patch_count(); ++i) {
        int level = block_at(*frame_, frame_->header().trees.get()[0].patches.get()[i].root).header->level;
        for (; level > 0; --level)
            for (const BlockView& b : blocks_of(*frame_, i, 0, level)) {
                ++coarse;
                std::vector<BlockView> below{b};
                while (!below.empty()) {
                    const BlockView d = below.back();
                    below.pop_back();
                    for (int v = 0; v < d.header->stride; ++v)
                        for (int k = 0; k < 3; ++k) {
                            const float x = d.vertex(v)[static_cast<std::size_t>(k)];
                            ASSERT_LE(b.header->box_low[k], x)
                                << "patch " << i << ", level " << d.header->level << " below " << level;
                            ASSERT_GE(b.header->box_high[k], x)
                                << "patch " << i << ", level " << d.header->level << " below " << level;
                        }
                    if (d.header->level == 0)
                        continue;
                    ASSERT_EQ(d.header->children.word, ready);
                    for (int c = 0; c < children_in(d.header->child_shape); ++c)
                        below.push_back(block_at(*frame_, d.header->child_line +
                                                              c * lines_between(d.header->child_shape)));
                }
            }
    }
    RecordProperty("coarse_blocks", coarse);
    if (GetParam() == "spot" || GetParam() == "torus_stretched" || GetParam() == "urchin_bilinear") {
        EXPECT_GT(coarse, 100);
    }
}

/// What a coarse level has of a finer one's vertices lies at the same place, bit for bit, unless it hangs at
/// the coarse one.
TEST_P(Geometry, LevelsAreNested) {
    for (int i = 0; i < patch_count(); ++i) {
        int coarsest = block_at(*frame_, frame_->header().trees.get()[0].patches.get()[i].root).header->level;
        for (int level = 1; level <= coarsest; ++level) {
            std::map<std::array<int, 2>, Point> finer; // by place in the finer grid
            const auto place = [](const BlockView& b, int v) {
                return std::array<int, 2>{b.header->column * block_quads + v % (b.header->quads_u + 1),
                                          b.header->row * block_quads + v / (b.header->quads_u + 1)};
            };
            for (const BlockView& b : blocks_of(*frame_, i, 0, level - 1))
                for (int v = 0; v < b.header->stride; ++v) {
                    auto [same, first] = finer.try_emplace(place(b, v), b.vertex(v));
                    ASSERT_EQ(same->second, b.vertex(v)) << "patch " << i << ": blocks of one level disagree";
                }
            for (const BlockView& b : blocks_of(*frame_, i, 0, level)) {
                ASSERT_EQ(b.header->absolute,
                          b.header->level + frame_->header().instances.get()[0].first_level);
                for (int v = 0; v < b.header->stride; ++v) {
                    const std::array<int, 2> at = place(b, v);
                    const int last_u = 1 << b.header->exponent[0], last_v = 1 << b.header->exponent[1];
                    // Corners that are middles of edges hang where the edge's level does not have them.
                    if (at[0] == 0 || at[0] == last_u || at[1] == 0 || at[1] == last_v)
                        continue;
                    ASSERT_EQ(finer.at({2 * at[0], 2 * at[1]}), b.vertex(v))
                        << "patch " << i << ", level " << level;
                }
            }
        }
    }
}

/// And one with sides so different that finer blocks hang from edges longer than they are.
std::vector<std::string> scenes() {
    std::vector<std::string> names = single_mesh_scenes();
    names.emplace_back("tapered");
    return names;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Geometry, testing::ValuesIn(scenes()),
                         [](const auto& name) { return name.param; });

} // namespace
} // namespace razor::test
