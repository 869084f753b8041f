// Who renders what: the curve against its definition, stretches against a plain model of them, and that every
// tile is taken, and every pixel rendered, exactly once.
#include "tests/kernels/cages.h"
#include "tests/kernels/scheduling_kernel.h"
#include "tests/kernels/target_functions.h"

#include "razor/frame/frame.h"
#include "razor/frame/tree_groups.h"
#include "razor/native/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <thread>
#include <utility>

namespace razor::test {

RAZOR_TEST_FUNCTION(curve, const CurveArguments&)
RAZOR_TEST_FUNCTION(take, TakeArguments&)

namespace {

Scene picture_of(int width, int height) {
    Scene scene = scene_of(bilinear(cube_cage()), 4);
    scene.settings.width = width;
    scene.settings.height = height;
    return scene;
}

constexpr std::pair<int, int> sizes[] = {{1, 1}, {16384, 1}, {1, 16384}, {17, 33}, {1000, 7}};

struct Way {
    std::vector<std::int32_t> column, row;
    Way(const TargetFunction<const CurveArguments&>& target, int columns, int rows)
        : column(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)), row(column.size()) {
        target.run({columns, rows, column.data(), row.data()});
    }
};

TEST(ScreenCurve, ComesToEachTileOnceAndNextToTheOneBefore) {
    for (const auto& target : curve_of_targets()) {
        const bool all = target.name == std::string("plain") || target.name == std::string("avx512");
        const auto check = [&](int columns, int rows) {
            const Way way(target, columns, rows);
            std::set<std::pair<int, int>> seen;
            int diagonals = 0;
            for (std::size_t i = 0; i < way.row.size(); ++i) {
                const int x = way.column[i], y = way.row[i];
                ASSERT_TRUE(x >= 0 && x < columns && y >= 0 && y < rows)
                    << columns << "x" << rows << " " << i;
                seen.emplace(x, y);
                if (i == 0)
                    continue;
                const int dx = std::abs(x - way.column[i - 1]), dy = std::abs(y - way.row[i - 1]);
                ASSERT_EQ(std::max(dx, dy), 1) << columns << "x" << rows << " " << i;
                diagonals += dx + dy - 1;
            }
            EXPECT_EQ(seen.size(), way.row.size()) << columns << "x" << rows;
            const bool may = std::max(columns, rows) % 2 == 1 && std::min(columns, rows) % 2 == 0;
            EXPECT_LE(diagonals, may ? 1 : 0) << columns << "x" << rows;
        };
        for (int columns = 1; columns <= (all ? 34 : 9); ++columns)
            for (int rows = 1; rows <= (all ? 34 : 9); ++rows)
                check(columns, rows);
        check(2048, 1);
        check(1, 2048);
        check(125, 1);
        check(128, 127);
        check(64, 64);
    }
}

// What a stretch of n tiles touches is about as wide as high: of rows it would be n wide.
TEST(ScreenCurve, StretchesAreCompact) {
    for (const auto& [columns, rows] : {std::pair(64, 64), std::pair(128, 68), std::pair(50, 77)}) {
        const Way way(curve_of_targets().front(), columns, rows);
        for (std::size_t length : {16U, 64U, 256U}) {
            double sum = 0;
            int stretches = 0;
            for (std::size_t i = 0; i + length <= way.row.size(); i += length) {
                const auto side = [&](const std::vector<std::int32_t>& v) {
                    const auto begin = v.begin() + static_cast<std::ptrdiff_t>(i);
                    const auto [low, high] =
                        std::minmax_element(begin, begin + static_cast<std::ptrdiff_t>(length));
                    return *high - *low + 1;
                };
                sum += side(way.column) + side(way.row);
                ++stretches;
            }
            // A square's is twice the root; a Hilbert curve's stretches are half as long again on average.
            EXPECT_LT(sum / stretches, 3.2 * std::sqrt(static_cast<double>(length)))
                << columns << " " << rows << " " << length;
        }
    }
}

TEST(Stretches, LengthsAreRoundedDownToTheNextThatCanBeWritten) {
    int written = 0;
    for (int length = 0; length < 1 << 18; ++length) {
        const std::int32_t word = pack_stretch(12345, length);
        EXPECT_EQ(stretch_begin(word), 12345);
        const auto bits = static_cast<unsigned>(length);
        const int width = static_cast<int>(std::bit_width(bits));
        if (width <= stretch_mantissa + 1 || std::countr_zero(bits) >= width - (stretch_mantissa + 1))
            written = length;
        ASSERT_EQ(stretch_length(word), written) << length;
    }
}

/// What stretches are to be, without words: who has what left.
class Model {
public:
    explicit Model(Frame& frame) : frame_(frame) {
        for (int m = 0; m < 512; ++m)
            for (int e = 0; e < 12; ++e)
                lengths_.insert(m << e);
        const FrameHeader& h = frame.header();
        for (int w = 0; w < frame.workers(); ++w) {
            const WorkerRecord& r = h.workers.get()[w];
            worker_at_[r.place] = w;
            const std::int32_t word = h.stretches.get()[r.place].left.word;
            left_[r.place] = {stretch_begin(word), stretch_begin(word) + stretch_length(word)};
        }
    }
    using Range = std::pair<int, int>;
    Range take_back(int worker, int least) {
        Range& mine = left_[frame_.header().workers.get()[worker].place];
        if (mine.second - mine.first < least)
            return {0, 0};
        const Range run{mine.first + down(mine.second - mine.first - 1), mine.second};
        mine.second = run.first;
        return run;
    }
    const std::map<int, Range>& left() const { return left_; }
    Range take(int worker) {
        const FrameHeader& h = frame_.header();
        const int place = h.workers.get()[worker].place;
        if (left_[place].first == left_[place].second) {
            Range* victim = nullptr;
            std::tuple<bool, int> nearest{};
            for (auto& [other, range] : left_) {
                const bool stranger = h.workers.get()[worker_at_[other]].tree != h.workers.get()[worker].tree;
                const std::tuple key(stranger, other ^ place);
                if (range.first < range.second && (victim == nullptr || key < nearest)) {
                    victim = &range;
                    nearest = key;
                }
            }
            if (victim == nullptr)
                return {0, 0};
            const int kept = down((victim->second - victim->first) / 2);
            left_[place] = {victim->first + kept, victim->second};
            victim->second = victim->first + kept;
        }
        Range& mine = left_[place];
        const Range run{mine.first, mine.second - down(mine.second - mine.first - 1)};
        mine.first = run.second;
        return run;
    }

private:
    int down(int length) const { return *std::prev(lengths_.upper_bound(length)); }
    Frame& frame_;
    std::set<int> lengths_;
    std::map<int, int> worker_at_;
    std::map<int, Range> left_;
};

TEST(Stretches, AreDealtEvenly) {
    for (const auto& [width, height, workers] :
         {std::tuple(17, 33, 4), std::tuple(17, 33, 64), std::tuple(3000, 3000, 7),
          std::tuple(16384, 16384, 3), std::tuple(1024, 1024, 1), std::tuple(32768, 32768, 1)}) {
        Frame frame(picture_of(width, height), {.workers = workers});
        const FrameHeader& h = frame.header();
        const std::int64_t tiles = screen_tiles(picture_of(width, height).settings);
        EXPECT_EQ(tiles, std::int64_t{(width + 7) / 8} * ((height + 7) / 8));
        int end = 0, least = std::numeric_limits<int>::max(), most = 0;
        const Model model(frame);
        for (const auto& [place, range] : model.left()) {
            EXPECT_EQ(range.first, end) << place;
            end = range.second;
            least = std::min(least, range.second - range.first);
            most = std::max(most, range.second - range.first);
        }
        const std::int64_t strides = (tiles + (1 << h.stride_log2) - 1) >> h.stride_log2;
        EXPECT_GE(end, strides);
        EXPECT_LE(end, strides + most / 256);
        EXPECT_LE(most - least, std::max(1, most / 256)) << width << " " << workers;
        EXPECT_GT(std::int64_t{end} << (h.stride_log2 + 1), tiles)
            << "strides are no longer than they must be";
        EXPECT_EQ(h.stride_log2 > 0, tiles > most_strides);
    }
}

// Workers take turns in any order, and what each gets is what the model says.
TEST(Stretches, EqualAModel) {
    std::mt19937 random(3);
    for (const auto& target : take_of_targets())
        for (const auto& [width, height, workers, share] :
             {std::tuple(17, 33, 4, 1), std::tuple(1000, 700, 7, 3), std::tuple(640, 480, 9, 2),
              std::tuple(3000, 3000, 2, 0), std::tuple(16384, 8192, 3, 0)}) {
            std::vector<int> places(static_cast<std::size_t>(workers));
            for (int w = 0; w < workers; ++w)
                places[static_cast<std::size_t>(w)] = w * 5 % workers; // 5 divides none of them
            Frame frame(picture_of(width, height), {.workers = workers,
                                                    .tree_of_worker = tree_groups(workers, share),
                                                    .place_of_worker = places});
            Model model(frame);
            const std::int64_t tiles = screen_tiles(picture_of(width, height).settings);
            std::vector<isa::shared<std::int32_t>> taken(static_cast<std::size_t>(tiles));
            Counters counters;
            std::int64_t steals = 0;
            for (int idle = 0; idle < 20 * workers;) {
                // The first is faster than the others, so that it becomes a thief early.
                const int worker =
                    random() % 2 == 0 ? 0 : static_cast<int>(random() % static_cast<unsigned>(workers));
                const int least = random() % 8 == 0 ? 1 + static_cast<int>(random() % 6) : 0;
                TakeArguments a{&frame.header(), worker, &counters, taken.data(), 1, least};
                target.run(a);
                const auto [first, end] = least != 0 ? model.take_back(worker, least) : model.take(worker);
                ASSERT_EQ(a.last, first < end ? end - 1 : -1) << target.name << " " << width;
                if (first < end) {
                    ASSERT_EQ(a.first_run, first) << target.name << " " << width;
                } else {
                    ++idle;
                }
                steals = counters.steals;
            }
            EXPECT_TRUE(std::all_of(taken.begin(), taken.end(), [](const auto& n) { return n.word == 1; }));
            EXPECT_GT(steals, 0);
            EXPECT_GE(counters.stolen_strides, steals);
            EXPECT_EQ(counters.lost_races, 0);
            EXPECT_EQ(frame.progress(), 1);
        }
}

TEST(Stretches, EveryTileIsTakenOnce) {
    for (const auto& target : take_of_targets()) {
        if (target.name == std::string("simulated"))
            continue; // its port is of one thread
        for (int workers = 1; workers <= 9; ++workers)
            for (const auto& [width, height] : sizes) {
                for (int share : {0, 1, 2}) {
                    Frame frame(picture_of(width, height),
                                {.workers = workers, .tree_of_worker = tree_groups(workers, share)});
                    const auto tiles =
                        static_cast<std::size_t>(screen_tiles(picture_of(width, height).settings));
                    std::vector<isa::shared<std::int32_t>> taken(tiles);
                    std::vector<Counters> counters(static_cast<std::size_t>(workers));
                    {
                        std::vector<std::jthread> threads;
                        for (int w = 0; w < workers; ++w)
                            threads.emplace_back([&, w] {
                                TakeArguments a{&frame.header(), w, &counters[static_cast<std::size_t>(w)],
                                                taken.data(), 1};
                                do {
                                    a.least = a.least == 0 ? 4 : 0;
                                    target.run(a);
                                } while (a.last >= 0 || a.least != 0);
                            });
                    }
                    for (std::size_t tile = 0; tile < tiles; ++tile)
                        ASSERT_EQ(taken[tile].word, 1)
                            << target.name << ", tile " << tile << " of " << width << "x" << height << ", "
                            << workers << " workers, share " << share;
                }
            }
    }
}

// Small stretches, again and again, so that takes and steals of one word meet.
TEST(Stretches, EveryTileIsTakenOnceWhereThievesMeet) {
    constexpr int workers = 4, rounds = 400;
    const auto target = take_of_targets().front();
    Frame frame(picture_of(128, 128), {.workers = workers});
    std::vector<isa::shared<std::int32_t>> taken(256);
    std::vector<Counters> counters(workers);
    int round = 0;
    std::barrier<> all(workers);
    {
        std::vector<std::jthread> threads;
        for (int w = 0; w < workers; ++w)
            threads.emplace_back([&, w] {
                for (int n = 0; n < rounds; ++n) {
                    if (w == 0) {
                        round += std::all_of(taken.begin(), taken.end(),
                                             [n](const auto& times) { return times.word == n; })
                                     ? 1
                                     : 0;
                        frame.take_tiles(0, 256);
                    }
                    all.arrive_and_wait();
                    TakeArguments a{&frame.header(), w, &counters[static_cast<std::size_t>(w)], taken.data(),
                                    std::numeric_limits<int>::max()};
                    target.run(a);
                    all.arrive_and_wait();
                }
            });
    }
    EXPECT_EQ(round, rounds) << "rounds before which all tiles had been taken once a round";
    EXPECT_TRUE(std::all_of(taken.begin(), taken.end(), [](const auto& n) { return n.word == rounds; }));
}

// More tiles than a word could number one by one, and a worker that is slow to begin.
TEST(Stretches, EveryTileOfAHugePictureIsTakenOnce) {
    const auto target = take_of_targets().front();
    Frame frame(picture_of(16384, 16384), {.workers = 4});
    EXPECT_GT(frame.header().stride_log2, 0);
    std::vector<isa::shared<std::int32_t>> taken(2048U * 2048U);
    std::vector<Counters> counters(4);
    {
        std::vector<std::jthread> threads;
        for (int w = 1; w < 4; ++w)
            threads.emplace_back([&, w] {
                TakeArguments a{&frame.header(), w, &counters[static_cast<std::size_t>(w)], taken.data(),
                                std::numeric_limits<int>::max()};
                target.run(a);
            });
    }
    std::int64_t stolen = 0;
    for (const Counters& c : counters)
        stolen += c.stolen_strides;
    EXPECT_GT(stolen << frame.header().stride_log2, 1000 * 1000) << "all of the first worker's";
    EXPECT_TRUE(std::all_of(taken.begin(), taken.end(), [](const auto& n) { return n.word == 1; }));
}

TEST(Scheduling, EveryPixelIsRenderedOnce) {
    const float unwritten = std::bit_cast<float>(0x7fc12345U);
    for (const KernelTable* kernels : native_targets())
        for (const auto& [width, height] : sizes) {
            const Scene scene = picture_of(width, height);
            const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
            std::vector<float> first;
            for (int workers = 1; workers <= 9; workers += kernels == native_targets().back() ? 1 : 4) {
                Frame frame(scene, {.workers = workers, .tree_of_worker = tree_groups(workers, 2)});
                float* film = frame.header().film.get();
                std::fill_n(film, pixels * film_planes, unwritten);
                run_workers(frame, *kernels);
                const std::vector<float> picture(film, film + pixels * film_planes);
                for (float v : picture)
                    ASSERT_NE(std::bit_cast<std::uint32_t>(v), std::bit_cast<std::uint32_t>(unwritten))
                        << width << "x" << height << " " << workers;
                EXPECT_EQ(frame.statistics().by_kind.kind[kind_camera].rays,
                          static_cast<std::int64_t>(pixels) * scene.settings.samples)
                    << width << "x" << height << " " << workers;
                if (first.empty())
                    first = picture;
                EXPECT_EQ(std::memcmp(first.data(), picture.data(), pixels * film_planes * sizeof(float)), 0)
                    << width << "x" << height << " " << workers;
            }
        }
}

// One worker alone renders what others were to render; some tiles alone are those of the curve.
TEST(Scheduling, WhoComesAloneDoesAll) {
    const Scene scene = picture_of(40, 24); // 5 x 3 tiles
    const KernelTable& kernels = *native_targets().back();
    Frame frame(scene, {.workers = 3, .tree_of_worker = {1, 0, 1}});
    EXPECT_EQ(frame.progress(), 0);
    frame.render(kernels, 1);
    EXPECT_EQ(frame.statistics().tiles, 15);
    EXPECT_GT(frame.statistics().counters.steals, 1);
    EXPECT_EQ(frame.progress(), 1);
    const Film whole = frame.film();
    Frame part(scene, {});
    std::fill_n(part.header().film.get(), 40 * 24 * film_planes, -1.0F);
    part.take_tiles(4, 11);
    part.render(kernels, 0);
    EXPECT_EQ(part.statistics().tiles, 7);
    const Way way(curve_of_targets().front(), 5, 3);
    std::set<std::pair<int, int>> there;
    for (std::size_t tile = 4; tile < 11; ++tile)
        there.emplace(way.column[tile], way.row[tile]);
    const Film some = part.film();
    for (const char* plane : {"R", "depth.Z"})
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 40; ++x) {
                const auto at = static_cast<std::size_t>(y * 40 + x);
                ASSERT_EQ(some.find(plane)->values[at],
                          there.contains({x / 8, y / 8}) ? whole.find(plane)->values[at] : -1)
                    << x << " " << y;
            }
}

// Another worker is splitting all nodes that are left to split, and takes its time: tiles from the back of
// the stretch are rendered first, once each, and no tile's time is counted as another's.
TEST(Scheduling, OtherTilesAreRenderedInPlaceOfAWait) {
    const Scene scene = small_default_scene(96, 72);
    for (const KernelTable* kernels : native_targets()) {
        Frame whole(scene, {});
        whole.render(*kernels, 0);
        Frame frame(scene, {});
        frame.take_tiles(50, 51);
        frame.render(*kernels, 0);
        const FrameHeader& h = frame.header();
        const FrameStatistics first = frame.statistics();
        std::vector<std::int32_t*> held;
        for (int n = h.trees.get()->root; n < h.workers.get()->node_next; ++n)
            if (std::int32_t& state = h.nodes.get()[n].state.word; state == node_unsplit) {
                state = node_busy;
                held.push_back(&state);
            }
        frame.take_tiles(0, 108);
        const auto begin = std::chrono::steady_clock::now();
        {
            const std::jthread worker([&] { frame.render(*kernels, 0); });
            while (frame.progress() < 1.9 / 108)
                std::this_thread::yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(300));
            for (std::int32_t* state : held)
                std::atomic_ref(*state).store(node_unsplit, std::memory_order_release);
        }
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const FrameStatistics s = frame.statistics();
        EXPECT_GE(s.counters.meanwhile_runs, 1);
        EXPECT_LE(s.counters.meanwhile_runs, 20) << "what waits in a tile begun meanwhile only waits";
        EXPECT_GE(s.counters.waits, 1);
        EXPECT_GT(s.wait_seconds, 0.02);
        EXPECT_EQ(s.tiles, 1 + 108);
        EXPECT_LT(s.tile_seconds - first.tile_seconds, seconds);
        EXPECT_EQ(s.by_kind.kind[kind_camera].rays - first.by_kind.kind[kind_camera].rays,
                  96 * 72 * scene.settings.samples);
        EXPECT_EQ(std::memcmp(h.film.get(), whole.header().film.get(),
                              std::size_t{96} * 72 * film_planes * sizeof(float)),
                  0)
            << kernels->name;
    }
}

TEST(Scheduling, StopsUntilTilesAreDealtAgain) {
    const Scene scene = picture_of(40, 24);
    const KernelTable& kernels = *native_targets().back();
    Frame frame(scene, {.workers = 2});
    frame.stop();
    frame.render(kernels, 0);
    EXPECT_EQ(frame.statistics().tiles, 0);
    EXPECT_LT(frame.progress(), 1);
    frame.take_tiles(2, 5);
    frame.render(kernels, 1);
    EXPECT_EQ(frame.statistics().tiles, 3);
    frame.stop();
    frame.reset();
    frame.render(kernels, 0);
    EXPECT_EQ(frame.statistics().tiles, 15);
}

// Who shares a tree, and then who is near, has near parts of the screen.
TEST(Scheduling, PlacesFollowTreesAndThenPlaces) {
    const Scene scene = picture_of(64, 64);
    Frame frame(scene,
                {.workers = 6, .tree_of_worker = {0, 1, 0, 1, 2, 0}, .place_of_worker = {9, 5, 7, 1, 0, 8}});
    const FrameHeader& h = frame.header();
    const int expected[] = {2, 4, 0, 3, 5, 1};
    for (int w = 0; w < 6; ++w)
        EXPECT_EQ(h.workers.get()[w].place, expected[w]) << w;
    const std::pair<int, int> spans[] = {{0, 3}, {3, 5}, {5, 6}};
    for (int t = 0; t < 3; ++t)
        EXPECT_EQ(std::pair(h.trees.get()[t].first_place, h.trees.get()[t].end_place), spans[t]) << t;
    EXPECT_THROW(Frame(scene, {.workers = 2, .place_of_worker = {0}}), std::invalid_argument);
}

} // namespace
} // namespace razor::test
