// Which way to simulate is chosen: by the ways' own errors, from cheap to dear, never a cheaper one for less
// error.
#include "sim/estimate/fidelity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace sim::test {
namespace {

using State = Rung::State;

/// Ways with errors that are known here alone.
struct Ladder {
    std::vector<Rung> rungs;
    std::vector<OwnError> own; // of each, if it is run
    std::vector<int> runs, pilots;

    void add(Way way, double fraction, OwnError error) {
        rungs.push_back({way, "", fraction});
        own.push_back(error);
        runs.push_back(0);
        pilots.push_back(0);
    }
    std::size_t choose(double wanted) {
        return choose_fidelity(wanted, rungs,
                               {[this](std::size_t i) {
                                    ++runs[i];
                                    return own[i];
                                },
                                [this](std::size_t i) {
                                    ++pilots[i];
                                    return own[i].error;
                                }});
    }
};

/// Samples whose intervals are as the smallest one's says, times chance.
Ladder drawn(std::mt19937& random) {
    std::uniform_real_distribution<double> any(0, 1);
    const auto chance = [&] { return std::exp2(2 * any(random) - 1); };
    Ladder out;
    const double closed = 0.4 * any(random), spread = 0.2 * any(random), counts = 0.02;
    out.add(Way::closed_form, 0, {{closed, closed * chance()}});
    out.rungs.back().predicted = out.own.back().error;
    for (const double fraction : {0.03, 0.06, 0.12, 0.25}) {
        const double width = spread * std::sqrt(0.03 / fraction) * chance();
        out.add(Way::sampled, fraction, {{width, counts}, width * any(random)});
        out.rungs.back().predicted = RelativeError{std::nan(""), counts};
    }
    for (int fast = 0; fast < 2; ++fast)
        out.add(Way::fast, 0, {{0.1 * any(random), 0.1 * any(random)}});
    out.add(Way::reference, 0, {});
    for (Rung& rung : out.rungs)
        if (rung.way != Way::reference && any(random) < 0.2)
            rung.impossible = "so";
    return out;
}

TEST(Fidelity, WithinWhatIsWantedAndNeverCheaperForLess) {
    std::mt19937 random(7);
    std::vector<int> chosen_ways(4);
    int cheaper_than_dearest = 0;
    for (int round = 0; round < 5000; ++round) {
        const Ladder ladder = drawn(random);
        std::size_t before = 0;
        for (const double wanted : {1.0, 0.5, 0.3, 0.2, 0.1, 0.07, 0.05, 0.03, 0.02, 0.01, 0.001, 0.0}) {
            Ladder tried = ladder;
            const std::size_t chosen = tried.choose(wanted);
            ASSERT_GE(chosen, before) << "a cheaper way for less error";
            before = chosen;
            ++chosen_ways[static_cast<std::size_t>(ladder.rungs[chosen].way)];
            cheaper_than_dearest += chosen + 1 < ladder.rungs.size() ? 1 : 0;
            EXPECT_LE(ladder.own[chosen].error.worst(), wanted);
            for (std::size_t i = 0; i < tried.rungs.size(); ++i) {
                const Rung& rung = tried.rungs[i];
                EXPECT_EQ(rung.state == State::chosen, i == chosen);
                EXPECT_EQ(tried.runs[i],
                          rung.state == State::chosen || rung.state == State::too_wide ? 1 : 0);
                EXPECT_EQ(rung.error.has_value(), tried.runs[i] == 1);
                EXPECT_LE(tried.pilots[i], rung.way == Way::fast ? 1 : 0);
                EXPECT_EQ(rung.state == State::not_needed, i > chosen);
                if (i < chosen) {
                    EXPECT_EQ(rung.state == State::impossible, !rung.impossible.empty());
                    EXPECT_TRUE(rung.state != State::too_wide || rung.error->worst() > wanted);
                    // What is passed over was expected to miss.
                    EXPECT_TRUE(rung.state != State::passed_over || wanted == 0 ||
                                rung.predicted->worst() > wanted);
                }
            }
        }
        EXPECT_EQ(before, ladder.rungs.size() - 1) << "0 is the reference mode";
    }
    for (const int way : chosen_ways)
        EXPECT_GT(way, 100) << "every way is chosen now and then";
    EXPECT_GT(cheaper_than_dearest, 10000);
}

TEST(Fidelity, ZeroRunsTheReferenceAlone) {
    std::mt19937 random(1);
    Ladder ladder = drawn(random);
    EXPECT_EQ(ladder.choose(0), ladder.rungs.size() - 1);
    for (std::size_t i = 0; i < ladder.rungs.size(); ++i) {
        EXPECT_EQ(ladder.runs[i], i + 1 == ladder.rungs.size() ? 1 : 0);
        EXPECT_EQ(ladder.pilots[i], 0);
    }
}

// The smallest sample says which of the others is worth running.
TEST(Fidelity, PassesOverSamplesThatAreTooSmall) {
    Ladder ladder;
    for (const double fraction : {0.03, 0.06, 0.12, 0.25}) {
        const double width = 0.08 * std::sqrt(0.03 / fraction);
        ladder.add(Way::sampled, fraction, {{width, 0.01}, width});
    }
    ladder.add(Way::reference, 0, {});
    EXPECT_EQ(ladder.choose(0.041), 2U);
    EXPECT_EQ(ladder.rungs[0].state, State::too_wide);
    EXPECT_EQ(ladder.rungs[1].state, State::passed_over); // 0.0566
    EXPECT_NEAR(ladder.rungs[1].predicted->cycles, 0.08 / std::sqrt(2), 1e-12);
    EXPECT_NEAR(ladder.rungs[2].predicted->cycles, 0.04, 1e-12);
    EXPECT_EQ(ladder.rungs[3].state, State::not_needed);
}

// Half a 95 % interval of three numbers by hand: 4.302653 x s / sqrt(3).
TEST(Fidelity, PilotsTellTheMeanAndItsInterval) {
    EXPECT_NEAR(pilot_error({0.01, 0.02, 0.03}), 0.02 + 4.302653 * 0.01 / std::sqrt(3.0), 1e-7);
    EXPECT_NEAR(pilot_error({-0.01, -0.02, -0.03}), pilot_error({0.01, 0.02, 0.03}), 1e-15);
    EXPECT_EQ(pilot_error({0.5, 0.5}), 0.5);
    EXPECT_EQ(pilot_error({0.5}), std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace sim::test
