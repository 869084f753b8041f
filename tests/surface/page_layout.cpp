// Keys, sizes and contents of pages.
#include "meshes.h"

#include "razor/surface/page_layout.h"
#include "razor/surface/pages.h"
#include "razor/surface/refiner.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>
#include <tuple>

namespace razor::test {
namespace {

TEST(Pages, KeysInvertTheIndexFormulas) {
    for (const int corners : {4, 5}) {
        const FaceClass c{0, 20, corners, false};
        const ClassRecord r = class_record(c, max_exponent_limit);
        const int sub = corners - 4;
        for (int nu = 0; nu <= max_exponent_limit; ++nu) {
            for (int su = 0; su < strip_count(nu); ++su) {
                const int u = strip_first(nu) + su;
                for (int nv = 0; nv <= max_exponent_limit; nv += 2) {
                    const int sv = su % strip_count(nv), v = strip_first(nv) + sv;
                    const int index = (strip_pair(u, v) * r.subs + sub) * block_kinds;
                    const PageKey key = page_key(3, PageKind::derivative, index, corners);
                    ASSERT_EQ(std::tuple(key.face_class, key.local, key.exponent_u, key.strip_u,
                                         key.exponent_v, key.strip_v),
                              std::tuple(3, sub, nu, su, nv, sv));
                }
                for (const bool reversed : {false, true}) {
                    const int local = r.curve_ways / 2 - 1, index = u * r.curve_ways + local * 2 + reversed;
                    const PageKey key = page_key(0, PageKind::curve, index, corners);
                    ASSERT_EQ(std::tuple(key.local, key.reversed, key.exponent_u, key.strip_u),
                              std::tuple(local, reversed, nu, su));
                }
            }
        }
        EXPECT_EQ(page_key(0, PageKind::vertex, corners, corners).local, corners);
    }
}

TEST(Pages, PairsOfStripsAreNumberedWithoutGapsCoarseOnesFirst) {
    const int strips = strip_first(7);
    std::vector<int> seen(static_cast<std::size_t>(strips * strips), 0);
    for (int u = 0; u < strips; ++u) {
        for (int v = 0; v < strips; ++v) {
            ++seen.at(static_cast<std::size_t>(strip_pair(u, v)));
            EXPECT_LT(strip_pair(u, v), (std::max(u, v) + 1) * (std::max(u, v) + 1));
        }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), strips * strips);
}

TEST(Pages, EntriesDoNotOverlap) {
    for (const int corners : {3, 4, 7}) {
        const FaceClass c{0, 37, corners, false};
        constexpr int exponent = 5;
        const ClassRecord r = class_record(c, exponent);
        const int subs = corners == 4 ? 1 : corners, curves = corners == 4 ? 4 : 2 * corners;
        // Sub-faces have one exponent less than the edges that they halve.
        const int strips = strip_first(corners == 4 ? exponent + 1 : exponent);
        EXPECT_EQ(r.subs, subs);
        EXPECT_EQ(r.curve_ways, 2 * curves);
        EXPECT_EQ(r.first[0], 0);
        EXPECT_EQ(r.first[1], corners + 1);
        EXPECT_EQ(r.first[2], r.first[1] + 2 * curves * strip_first(exponent + 1));
        EXPECT_EQ(r.first[3], r.first[2] + 1);
        EXPECT_EQ(r.first[4], r.first[2] + 2);
        EXPECT_EQ(class_entries(c, exponent), r.first[2] + block_kinds * subs * strips * strips);
    }
}

TEST(Pages, AllCagesHaveFourteenLevels) {
    for (const int sides : {5, 64, 256}) {
        const Topology t = analyse_topology(prism(sides));
        EXPECT_EQ(t.max_exponent, max_exponent_limit);
        for (const FaceClass& c : t.classes) {
            EXPECT_LT(class_entries(c, t.max_exponent), most_class_entries);
        }
    }
}

TEST(Pages, TheLargestExponentIsTheLastThatCanBeNumbered) {
    const auto largest = [](std::size_t count, int corners) {
        return largest_exponent(prism(5), std::vector<FaceClass>(count, FaceClass{0, 20, corners, false}));
    };
    EXPECT_EQ(largest(1, 256), 13);
    EXPECT_EQ(largest(1, 1024), 12);
    for (const std::size_t count : {20'000U, 30'000U, 100'000U, 1'000'000U}) {
        const int exponent = largest(count, 4);
        const FaceClass c{0, 20, 4, false};
        const auto n = static_cast<std::int64_t>(count);
        EXPECT_LT(n * class_entries(c, exponent), most_mesh_entries);
        EXPECT_TRUE(exponent == 13 || n * class_entries(c, exponent + 1) >= most_mesh_entries);
    }
    EXPECT_EQ(largest(20'000, 4), 13);
    EXPECT_EQ(largest(100'000, 4), 11);
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

TEST(Pages, NothingIsApproximatedDownToTheLastRefinement) {
    // The finest such blocks at the four corners of each class, where one level less (and sharpness lower by
    // one) must change nothing. OpenSubdiv cannot go deeper: its patches count in 2^10 steps.
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
            key.exponent_u = key.exponent_v = deepest - 2; // and a sub-face is half of a face
            for (const int u : {0, strip_count(key.exponent_u) - 1}) {
                for (const int v : {0, strip_count(key.exponent_v) - 1}) {
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

/// A mesh of quads, and its faces' first children's first children ..., after `levels` refinements.
struct Refined {
    Mesh mesh;
    std::vector<int> child;
};
Refined refined(const Mesh& mesh, int levels) {
    Refined r{mesh, {}};
    for (int f = 0; f < static_cast<int>(mesh.face_sizes.size()); ++f) {
        r.child.push_back(f);
    }
    struct Point {
        glm::dvec3 p{0};
        void Clear() { p = glm::dvec3(0); }
        void AddWithWeight(const Point& o, double w) { p += w * o.p; }
    };
    for (int level = 0; level < levels; ++level) {
        const auto refiner = make_refiner(r.mesh);
        refiner->RefineUniform(OpenSubdiv::Far::TopologyRefiner::UniformOptions(1));
        std::vector<Point> from, to(static_cast<std::size_t>(refiner->GetLevel(1).GetNumVertices()));
        for (const glm::dvec3& p : r.mesh.points) {
            from.push_back({p});
        }
        OpenSubdiv::Far::PrimvarRefinerReal<double>(*refiner).Interpolate(1, from, to);
        Mesh next;
        for (const Point& p : to) {
            next.points.push_back(p.p);
        }
        for (int f = 0; f < refiner->GetLevel(1).GetNumFaces(); ++f) {
            next.face_sizes.push_back(4);
            for (const int v : refiner->GetLevel(1).GetFaceVertices(f)) {
                next.face_vertices.push_back(v);
            }
        }
        for (int& f : r.child) {
            f = refiner->GetLevel(0).GetFaceChildFaces(f)[0];
        }
        r.mesh = std::move(next);
    }
    return r;
}

TEST(Pages, BesideExtraordinaryPointsTheFinestAreNearTheLimit) {
    // A cage refined four times has the same limit, and its blocks of exponent 9 are those of 13.
    constexpr int refinements = 4, fine = max_exponent_limit - refinements;
    for (const auto& [mesh, bound] :
         {std::pair{cube(), 1e-5}, {quad_pole(5), 1e-4}, {quad_pole(12), 1e-3}, {quad_pole(30), 3e-3}}) {
        const Refined other = refined(mesh, refinements);
        const Topology t = analyse_topology(mesh), finer = analyse_topology(other.mesh);
        const PageMaker maker(mesh, t), exact(other.mesh, finer);
        const auto corner = [](const Mesh& m, const Topology& topology, const PageMaker& pages, int face,
                               int exponent) {
            const FaceRecord& record = topology.faces[static_cast<std::size_t>(face)];
            PageKey key;
            key.face_class = record.face_class;
            key.exponent_u = key.exponent_v = exponent;
            const std::vector<float> weights = make(pages, topology, key);
            const auto controls = static_cast<std::size_t>(record.control_count);
            std::vector<glm::dvec3> points(block_vertices, glm::dvec3(0));
            for (std::size_t c = 0; c < controls; ++c) {
                const int control = topology.controls[static_cast<std::size_t>(record.control_first) + c];
                for (std::size_t i = 0; i < points.size(); ++i) {
                    points[i] += double{weights[c * (weights.size() / controls) + i]} *
                                 m.points[static_cast<std::size_t>(control)];
                }
            }
            return points;
        };
        double worst = 0, worst_corner = 0;
        for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
            const auto a = corner(mesh, t, maker, static_cast<int>(f), max_exponent_limit);
            const auto b = corner(other.mesh, finer, exact, other.child[f], fine);
            for (std::size_t i = 0; i < a.size(); ++i) {
                const double off = glm::length(a[i] - b[i]) / extent(mesh);
                worst = std::max(worst, off);
                // Corners of the last patches: multiples of 2^-10.
                if (i % block_side % 8 == 0 && i / block_side % 8 == 0) {
                    worst_corner = std::max(worst_corner, off);
                }
            }
        }
        fmt::print("  {}: {:.1e} of the cage's size, at corners of patches {:.1e}\n", mesh.name, worst,
                   worst_corner);
        EXPECT_LT(worst, bound);
        EXPECT_LT(worst_corner, 1e-6);
    }
}

TEST(Pages, SharedEdgesHaveTheSameWeightsAtTheFinestExponentFromEitherEnd) {
    for (const Mesh& mesh : {cube(), prism(5), quad_pole(12)}) {
        const Topology t = analyse_topology(mesh);
        const PageMaker maker(mesh, t);
        for (int c = 0; c < static_cast<int>(t.classes.size()); ++c) {
            PageKey forward;
            forward.face_class = c;
            forward.kind = PageKind::curve;
            forward.exponent_u = max_exponent_limit;
            PageKey backward = forward;
            backward.reversed = true;
            const int last = strip_count(max_exponent_limit) - 1;
            for (const int strip : {0, 1, 700, last}) {
                forward.strip_u = strip;
                backward.strip_u = last - strip;
                const std::vector<float> f = make(maker, t, forward), b = make(maker, t, backward);
                for (std::size_t i = 0; i < f.size(); i += curve_row) {
                    for (std::size_t k = 0; k <= 8; ++k) {
                        ASSERT_EQ(f[i + k], b[i + 8 - k]);
                    }
                }
            }
        }
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
