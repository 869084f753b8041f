// Keys, sizes and contents of pages.
#include "meshes.h"

#include "razor/surface/page_layout.h"
#include "razor/surface/pages.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>
#include <tuple>

namespace razor::test {
namespace {

TEST(Pages, KeysInvertTheIndexFormulas) {
    const int max_exponent = 8, strips = strip_first(max_exponent + 1);
    for (int nu = 0; nu <= max_exponent; ++nu) {
        for (int su = 0; su < strip_count(nu); ++su) {
            const int u = strip_first(nu) + su;
            for (int nv = 0; nv <= max_exponent; nv += 2) {
                const int v = strip_first(nv) + strip_count(nv) - 1;
                const PageKey key = page_key(3, PageKind::block, (2 * strips + u) * strips + v, 5, strips);
                EXPECT_EQ(std::tuple(key.face_class, key.local, key.exponent_u, key.strip_u, key.exponent_v,
                                     key.strip_v),
                          std::tuple(3, 2, nu, su, nv, strip_count(nv) - 1));
            }
            for (const bool reversed : {false, true}) {
                const PageKey key = page_key(0, PageKind::curve, (7 * 2 + reversed) * strips + u, 4, strips);
                EXPECT_EQ(std::tuple(key.local, key.reversed, key.exponent_u, key.strip_u),
                          std::tuple(7, reversed, nu, su));
            }
        }
    }
    EXPECT_EQ(page_key(0, PageKind::vertex, 4, 4, strips).local, 4);
}

TEST(Pages, SectionsHoldTheirPagesAndDoNotOverlap) {
    for (const int corners : {3, 4, 7}) {
        const FaceClass c{0, 37, corners, false};
        const ClassRecord r = class_record(c, 5);
        EXPECT_EQ(r.strips, strip_first(6));
        for (int k = 0; k < page_kinds; ++k) {
            const auto kind = static_cast<PageKind>(k);
            const auto floats = static_cast<std::int64_t>(largest_page_floats(kind, 37));
            EXPECT_EQ(r.stride[k], 1 + (floats + 15) / 16);
        }
        const int subs = corners == 4 ? 1 : corners, locals = corners == 4 ? 4 : 2 * corners;
        EXPECT_EQ(r.first[0], 0);
        EXPECT_EQ(r.first[1], (corners + 1) * r.stride[0]);
        EXPECT_EQ(r.first[2], r.first[1] + locals * 2 * r.strips * r.stride[1]);
        EXPECT_EQ(r.first[3], r.first[2] + subs * r.strips * r.strips * r.stride[2]);
        EXPECT_EQ(r.first[4], r.first[3] + subs * r.strips * r.strips * r.stride[3]);
        EXPECT_EQ(class_lines(c, 5), r.first[4] + std::int64_t{subs} * r.strips * r.strips * r.stride[4]);
    }
}

TEST(Pages, LargestExponentKeepsAddressesInRange) {
    for (const int sides : {5, 64, 256}) {
        const Topology t = analyse_topology(prism(sides));
        std::int64_t sum = 0;
        for (const FaceClass& c : t.classes) {
            EXPECT_LT(class_lines(c, t.max_exponent), class_page_lines);
            sum += class_lines(c, t.max_exponent);
        }
        EXPECT_LT(sum, mesh_page_lines);
        EXPECT_EQ(t.max_exponent < max_exponent_limit, sides == 256);
        EXPECT_GE(t.max_exponent, 5);
    }
}

std::vector<float> make(const PageMaker& maker, const Topology& t, const PageKey& key) {
    std::vector<float> page(
        page_floats(key, t.classes[static_cast<std::size_t>(key.face_class)].control_count), -7.0F);
    maker.make(key, page.data());
    return page;
}

TEST(Pages, PaddingIsZeroAndWeightsAddUp) {
    const Mesh mesh = prism(5);
    const Topology t = analyse_topology(mesh);
    const PageMaker maker(mesh, t);
    const int controls = t.classes[0].control_count;
    PageKey key;
    key.local = 2;
    key.exponent_u = 1;
    key.exponent_v = 2;
    const std::vector<float> block = make(maker, t, key);
    const std::size_t row = block.size() / static_cast<std::size_t>(controls);
    EXPECT_EQ(row % RAZOR_WIDTH, 0U);
    for (std::size_t i = 0; i < row; ++i) {
        double sum = 0;
        for (std::size_t c = 0; c < static_cast<std::size_t>(controls); ++c) {
            sum += static_cast<double>(block[c * row + i]);
        }
        EXPECT_NEAR(sum, i < 15 ? 1 : 0, 1e-6);
    }
    key.kind = PageKind::curve;
    key.exponent_v = 0;
    const std::vector<float> curve = make(maker, t, key);
    ASSERT_EQ(curve.size(), static_cast<std::size_t>(controls * curve_row));
    EXPECT_EQ(curve[3], 0.0F);
    key.kind = PageKind::vertex;
    key.exponent_u = 0;
    const std::vector<float> vertex = make(maker, t, key);
    ASSERT_EQ(vertex.size() % 64, 0U);
    EXPECT_TRUE(std::all_of(vertex.begin() + controls, vertex.end(), [](float w) { return w == 0.0F; }));
}

TEST(Pages, NeighbouringBlocksAgreeBitForBit) {
    const Mesh mesh = cube();
    const Topology t = analyse_topology(mesh);
    const PageMaker maker(mesh, t);
    const auto controls = static_cast<std::size_t>(t.classes[0].control_count);
    PageKey left;
    left.exponent_u = left.exponent_v = 5;
    left.strip_u = 1;
    left.strip_v = 2;
    PageKey right = left;
    ++right.strip_u;
    const std::vector<float> a = make(maker, t, left), b = make(maker, t, right);
    const std::size_t row = a.size() / controls;
    for (std::size_t c = 0; c < controls; ++c) {
        for (std::size_t j = 0; j < block_side; ++j) {
            EXPECT_EQ(a[c * row + j * block_side + 8], b[c * row + j * block_side]);
        }
    }
    // A coarser grid has the same points where it has any.
    PageKey coarse = left;
    coarse.exponent_u = coarse.exponent_v = 4;
    coarse.strip_u = 0;
    coarse.strip_v = 1;
    const std::vector<float> d = make(maker, t, coarse);
    for (std::size_t c = 0; c < controls; ++c) {
        EXPECT_EQ(a[c * row], d[c * row + 4]);
    }
}

TEST(Pages, CurvesMeetBlocksAndReverse) {
    const Mesh mesh = prism(6);
    const Topology t = analyse_topology(mesh);
    const PageMaker maker(mesh, t);
    const auto controls = static_cast<std::size_t>(t.classes[0].control_count);
    ASSERT_EQ(t.classes[0].corner_count, 6);
    PageKey forward;
    forward.kind = PageKind::curve;
    forward.local = 3;
    forward.exponent_u = 4;
    PageKey backward = forward;
    backward.reversed = true;
    backward.strip_u = 1;
    const std::vector<float> f = make(maker, t, forward), b = make(maker, t, backward);
    PageKey block;
    block.local = 3;
    block.exponent_u = 3; // the first half of edge 3, along v = 0 of sub-face 3
    const std::vector<float> s = make(maker, t, block);
    const std::size_t row = s.size() / controls;
    for (std::size_t c = 0; c < controls; ++c) {
        for (std::size_t i = 0; i <= 8; ++i) {
            EXPECT_EQ(f[c * curve_row + i], b[c * curve_row + 8 - i]);
            EXPECT_EQ(f[c * curve_row + i], s[c * row + i]);
        }
    }
}

TEST(Pages, SameFromManyThreadsInAnyOrder) {
    const Mesh mesh = triangle_pole(9);
    const Topology t = analyse_topology(mesh);
    std::vector<PageKey> keys;
    for (int c = 0; c < static_cast<int>(t.classes.size()); ++c) {
        for (const PageKind kind : {PageKind::block, PageKind::derivative, PageKind::curve, PageKind::vertex,
                                    PageKind::deviation}) {
            PageKey key;
            key.face_class = c;
            key.kind = kind;
            key.exponent_u = kind == PageKind::vertex ? 0 : 2;
            key.exponent_v = kind != PageKind::vertex && kind != PageKind::curve ? 3 : 0;
            keys.push_back(key);
        }
    }
    const PageMaker serial(mesh, t);
    std::vector<std::vector<float>> expected;
    for (const PageKey& key : keys) {
        expected.push_back(make(serial, t, key));
    }
    const PageMaker shared(mesh, t);
    std::vector<std::vector<std::vector<float>>> got(4, std::vector<std::vector<float>>(keys.size()));
    {
        std::vector<std::jthread> workers;
        for (std::size_t w = 0; w < got.size(); ++w) {
            workers.emplace_back([&, w] {
                for (std::size_t k = 0; k < keys.size(); ++k) {
                    const std::size_t at = w % 2 == 0 ? k : keys.size() - 1 - k;
                    got[w][at] = make(shared, t, keys[at]);
                }
            });
        }
    }
    for (const auto& pages : got) {
        EXPECT_EQ(pages, expected);
    }
}

TEST(Pages, NothingThatAFrameEvaluatesIsApproximated) {
    // The finest blocks at the four corners of each class, where one level less (and sharpness lower by one)
    // must change nothing. OpenSubdiv cannot go deeper: its patches count in 2^10 steps.
    Mesh sharp = quad_grid(6, 6);
    sharp.creases = {{16, 17, 8.5F}, {17, 18, 8.5F}, {18, 25, 4.5F}, {31, 32, 8.9F}};
    sharp.corners = {{37, 8.5F}};
    const int deepest = PageMaker::Options{}.approximation_level;
    EXPECT_EQ(deepest, 10);
    const auto difference = [&](const Mesh& mesh, int level) {
        const Topology t = analyse_topology(mesh);
        const PageMaker maker(mesh, t, PageMaker::Options{level}),
            deeper(mesh, t, PageMaker::Options{deepest});
        float worst = 0;
        for (int c = 0; c < static_cast<int>(t.classes.size()); ++c) {
            PageKey key;
            key.face_class = c;
            key.exponent_u = key.exponent_v = max_exponent_limit;
            for (const int u : {0, strip_count(max_exponent_limit) - 1}) {
                for (const int v : {0, strip_count(max_exponent_limit) - 1}) {
                    key.strip_u = u;
                    key.strip_v = v;
                    const std::vector<float> a = make(maker, t, key), b = make(deeper, t, key);
                    for (std::size_t i = 0; i < a.size(); ++i) {
                        worst = std::max(worst, std::abs(a[i] - b[i]));
                    }
                }
            }
        }
        return worst;
    };
    for (const Mesh& mesh : {cube(), prism(5), quad_pole(12), triangle_pole(30), sharp}) {
        EXPECT_LT(difference(mesh, deepest - 1), 1e-6F);
        EXPECT_GT(difference(mesh, 4), 1e-4F);
    }
}

TEST(Pages, Cost) {
    const auto time = [](const Mesh& mesh, int level) {
        const Topology t = analyse_topology(mesh);
        const PageMaker maker(mesh, t, PageMaker::Options{level});
        PageKey key;
        key.exponent_u = key.exponent_v = 3;
        const auto start = std::chrono::steady_clock::now();
        make(maker, t, key);
        const auto built = std::chrono::steady_clock::now();
        make(maker, t, key);
        const auto block = std::chrono::steady_clock::now();
        key.kind = PageKind::derivative;
        make(maker, t, key);
        const auto derivative = std::chrono::steady_clock::now();
        const auto us = [](auto d) { return std::chrono::duration<double, std::micro>(d).count(); };
        fmt::print("  {} controls, level {}: first block {:.0f} us, block {:.0f} us, derivative {:.0f} us\n",
                   t.classes[0].control_count, level, us(built - start), us(block - built),
                   us(derivative - block));
    };
    Mesh creased = quad_grid(6, 6);
    creased.creases = {{0, 1, 3}, {8, 9, 3}, {1, 8, 10}};
    for (const int level : {4, 10}) {
        time(cube(), level);
        time(creased, level);
        time(quad_pole(64), level);
        time(quad_pole(360), level);
    }
}

} // namespace
} // namespace razor::test
