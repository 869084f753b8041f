// Lines of words that several tiles write: who waits for them to move, and for how long.
#include "tests/sim/unchanging.h"

#include "sim/machine/word_moves.h"

#include <array>
#include <random>

namespace sim::test {
namespace {

constexpr cycle move = 2000, visibility = 40, service = 4;

/// Two tiles of four cores; workers 0 to 3 are the first one's.
Config two_tiles(const char* mode) {
    Config c;
    c.sim.mode = mode;
    c.memory.controller = "queued";
    c.chip.tiles = 2;
    c.chip.cores = 4;
    c.chip.threads = 1;
    c.chip.placement = "pack";
    c.coherence.remote_cycles = static_cast<integer>(move);
    c.coherence.visibility_cycles = static_cast<integer>(visibility);
    c.coherence.atomic_cycles = static_cast<integer>(service);
    return c;
}

/// When a read-modify-write that begins at `t` is done.
cycle add_at(word* w, cycle t) {
    before_atomic(here, atomic::fetch_add, w, stamp{t, t}, stamp{});
    ++w->word;
    return after_atomic(here, atomic::fetch_add, w, true).last;
}
/// When the value is there that a load at `t` reads.
cycle look_at(word* w, cycle t) {
    before_atomic(here, atomic::load_acquire, w, stamp{t, t}, stamp{});
    return when(after_atomic(here, atomic::load_acquire, w, false));
}

TEST(WordMoves, ALineMovesOnceForAllOfATileWhoAskBeforeItLeaves) {
    WordMoves moves(200, 10);
    auto write = [&](std::uint32_t tile, cycle t) { return moves.write({64, tile, t, t, 4}, 0); };
    EXPECT_EQ(write(0, 100), 300U); // from where nobody knows
    EXPECT_EQ(write(1, 100), 514U); // 4 + 10 cycles after tile 0's begins
    EXPECT_EQ(write(2, 101), 728U);
    EXPECT_EQ(write(0, 102), 314U); // was still on its way to tile 0
    EXPECT_EQ(write(1, 103), 528U);
    EXPECT_EQ(write(0, 314), 328U); // asks when it leaves
    EXPECT_EQ(write(0, 315), 942U); // has left; after tile 2
    EXPECT_EQ(write(0, 2000), 2000U);
    EXPECT_EQ(write(0, 3000), 3000U);
    EXPECT_EQ(write(1, 5000), 5200U);
    EXPECT_EQ(moves.write({64, 0, 5000, 5300, 4}, 0), 5300U);  // asked before it left
    EXPECT_EQ(moves.write({128, 1, 5000, 5000, 4}, 0), 5200U); // another word
}

TEST(WordMoves, WhatIsForgottenChangesNothing) {
    WordMoves all(200, 10), recent(200, 10);
    std::mt19937 random(5);
    cycle t = 1000;
    for (int i = 0; i < 5000; ++i) {
        t += random() % 150;
        const std::uint64_t word = random() % 3 * 64;
        const auto tile = static_cast<std::uint32_t>(random() % 5);
        const cycle at = t - random() % 100; // a thread that lags behind
        EXPECT_EQ(all.write({word, tile, at, at + 20, 4}, 0),
                  recent.write({word, tile, at, at + 20, 4}, t - 100));
    }
}

// In both modes: a thread whose tile wrote the word last gets it as fast as one that nobody else's tile
// writes, others wait for its line.
TEST(WordMoves, AReadModifyWritePaysOnlyForALineOfAnotherTile) {
    for (const char* mode : {"fast", "reference"}) {
        Shared s;
        std::array<cycle, 5> took{};
        auto timed = [&](cycle t) { return add_at(s.at(0), t) - t; };
        s.run(two_tiles(mode), 8, [&](int w) {
            add_at(s.at(0), 1000); // the word is the whole chip's from now on
            if (w == 0) {
                add_at(s.at(0), 50000); // brings the line, if it is not here
                took[0] = timed(60000);
            } else if (w == 1) {
                took[1] = timed(70000);
            } else if (w == 4) {
                took[2] = timed(80000);
                took[3] = timed(90000);
            } else if (w == 7) {
                took[4] = timed(100000);
            }
        });
        for (const int own : {0, 1, 3, 4})
            EXPECT_LT(took[u(own)], 100U) << mode << ", " << own;
        EXPECT_GT(took[2], move + service) << mode; // and its line's miss
        EXPECT_LT(took[2], move + 600) << mode;
        EXPECT_EQ(s.at(0)->word, 14) << mode;
    }
}

// Eight threads at once: the line goes to one tile and then to the other, not to and fro.
TEST(WordMoves, TilesThatFightForAWordTakeTurns) {
    for (const char* mode : {"fast", "reference"}) {
        Shared s;
        std::array<cycle, 8> done{};
        s.run(two_tiles(mode), 8, [&](int w) {
            add_at(s.at(0), 1000);
            done[u(w)] = add_at(s.at(0), 50000);
        });
        for (int tile = 0; tile < 2; ++tile) {
            auto first = done.begin() + tile * 4;
            std::sort(first, first + 4);
            for (int i = 1; i < 4; ++i)
                EXPECT_EQ(first[i] - first[i - 1], visibility + service) << mode << ", tile " << tile;
        }
        const cycle last = std::max(done[3], done[7]);
        EXPECT_GT(last, 50000 + move) << mode;
        EXPECT_LT(last, 50000 + 2 * move + 600) << mode;
    }
}

TEST(WordMoves, AWriteIsSeenLaterInOtherTiles) {
    Shared s;
    cycle near = 0, far = 0;
    s.run(two_tiles("fast"), 8, [&](int w) {
        add_at(s.at(0), 1000);
        if (w == 0) {
            before_atomic(here, atomic::store_release, s.at(0), stamp{50000, 50000}, stamp{});
            s.at(0)->word = 7;
            after_atomic(here, atomic::store_release, s.at(0), true);
        } else if (w == 1) {
            near = look_at(s.at(0), 51000); // after the window in which that acts
        } else if (w == 4) {
            far = look_at(s.at(0), 51000);
        }
    });
    EXPECT_LT(near, 51100U);
    EXPECT_GE(far, 50000 + visibility + move);
    EXPECT_LE(far, 50100 + visibility + move);
}

} // namespace
} // namespace sim::test
