// Predictors: mispredictions counted by hand, and by a plain model of McFarling's tables.
#include "sim/core/sites.h"
#include "tests/sim/machines.h"

#include <array>
#include <map>
#include <random>

namespace sim::test {
namespace {

constexpr int n = 1000;

struct Branch {
    std::uint32_t line;
    bool taken;
};

Report predict(const Config& c, const std::vector<Branch>& branches) {
    return run(c, [&](int) {
        for (const Branch& b : branches)
            isa::timing::branch({"predicted", b.line}, stamp{}, b.taken);
    });
}

Config with(const char* predictor, integer entries = 4096, integer history = 0) {
    Config c = simple();
    c.core.predictor = predictor;
    c.core.predictor_entries = entries;
    c.core.predictor_history = history;
    c.core.mispredict_cycles = 20;
    return c;
}

std::vector<Branch> alternating(std::vector<Branch> once) {
    std::vector<Branch> out;
    for (int i = 0; i < n; ++i)
        out.insert(out.end(), once.begin(), once.end());
    return out;
}

TEST(Predictor, StaticPredictionsAreWrongWhereTheyAreNot) {
    std::vector<Branch> loop(n, {1, true});
    loop.back().taken = false;
    EXPECT_EQ(predict(with("taken"), loop).core.mispredicts, 1U);
    Report r = predict(with("not_taken"), loop);
    EXPECT_EQ(r.core.mispredicts, u(n - 1));
    EXPECT_EQ(r.cycles, u((n - 1) * 21 + 1)); // each wrong one restarts 1 + 20 cycles later
}

TEST(Predictor, SitesShareCountersWhereThereAreTooFew) {
    std::vector<Branch> two = alternating({{700, true}, {900, false}});
    EXPECT_EQ(predict(with("bimodal", 2), two).core.mispredicts, 1U); // at first
    EXPECT_EQ(predict(with("bimodal", 1), two).core.mispredicts, u(n));
    EXPECT_EQ(predict(with("counters", 1), two).core.mispredicts, 1U);
    std::vector<Branch> three = alternating({{5, true}, {6, true}, {7, false}}); // the third meets the first
    EXPECT_EQ(predict(with("bimodal", 4), three).core.mispredicts, 1U);
    EXPECT_EQ(predict(with("bimodal", 2), three).core.mispredicts, u(n));
}

TEST(Predictor, HistoryLearnsAlternation) {
    std::vector<Branch> one = alternating({{1, true}, {1, false}});
    EXPECT_EQ(predict(with("bimodal", 64), one).core.mispredicts, u(n));
    EXPECT_EQ(predict(with("bimodal", 64, 6), one).core.mispredicts, u(n)); // has no history
    EXPECT_LE(predict(with("gshare", 64, 1), one).core.mispredicts, 2U);
}

TEST(Predictor, GshareIsMcFarlings) {
    std::mt19937 random(7);
    std::vector<Branch> branches;
    for (int i = 0; i < 20000; ++i) {
        auto line = static_cast<std::uint32_t>(10 + random() % 40);
        branches.push_back({line, random() % 8 < line % 9 || (i / 3) % 4 == 0});
    }
    for (auto [entries, history] : {std::pair{16U, 4U}, {64U, 3U}, {1024U, 10U}}) {
        std::vector<int> counters(entries, 2);
        std::map<std::uint32_t, std::uint32_t> places; // in order of first meeting
        std::uint32_t past = 0;
        std::uint64_t wrong = 0;
        for (const Branch& b : branches) {
            auto place = places.try_emplace(b.line, static_cast<std::uint32_t>(places.size())).first->second;
            int& counter = counters[(place ^ past % (1U << history)) % entries];
            wrong += (counter >= 2) != b.taken ? 1 : 0;
            counter = std::clamp(counter + (b.taken ? 1 : -1), 0, 3);
            past = 2 * past + (b.taken ? 1 : 0);
        }
        EXPECT_EQ(predict(with("gshare", entries, history), branches).core.mispredicts, wrong) << entries;
    }
}

TEST(Predictor, CoresNumberSitesThemselves) {
    Config c = with("bimodal", 2);
    c.chip.cores = 2;
    // Worker 0 meets a site that worker 1 does not: on its own core this moves nothing.
    Report r = run(
        c,
        [](int w) {
            if (w == 0)
                for (std::uint32_t line = 50; line < 53; ++line)
                    isa::timing::branch({"first", line}, stamp{}, true);
            for (int i = 0; w == 1 && i < n; ++i)
                for (std::uint32_t line : {51U, 53U})
                    isa::timing::branch({"first", line}, stamp{}, line == 51);
        },
        2);
    EXPECT_EQ(r.core.mispredicts, 1U);
}

TEST(Predictor, SitesAreNumberedAsTheyAreMet) {
    const std::array<std::string, 3> files = {"one", "another", "one"}; // the last is the first, elsewhere
    Sites sites;
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> expected;
    std::mt19937 random(1);
    for (int i = 0; i < 20000; ++i) {
        const std::string& file = files[random() % files.size()];
        const auto line = static_cast<std::uint32_t>(random() % 2000);
        const auto next = static_cast<std::uint32_t>(expected.size());
        EXPECT_EQ(sites.number({file.c_str(), line}), expected.try_emplace({file, line}, next).first->second);
    }
    EXPECT_GT(expected.size(), 3500U);
}

TEST(Predictor, SizesAreChecked) {
    EXPECT_NO_THROW(check_consistency(with("gshare", 1024, 10), "m"));
    EXPECT_THROW(check_consistency(with("gshare", 512, 10), "m"), ConfigError);
    EXPECT_THROW(check_consistency(with("counters", 4096, 11), "m"), ConfigError);
    EXPECT_NO_THROW(check_consistency(with("bimodal", 2, 20), "m"));
}

} // namespace
} // namespace sim::test
