// Several programs on one folder: each point is measured by one of them, whoever dies.
#include "analysis/study/claim.h"
#include "analysis/study/isolated.h"
#include "analysis/study/run.h"
#include "tests/analysis/study_parts.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace analysis {
namespace {

using namespace std::chrono_literals;

class StudyClaims : public ::testing::Test {
protected:
    StudyClaims() {
        const Study study =
            test_study("kind = \"test\"\n[knobs]\nsamples = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]\n");
        points_ = resolve_points(study, [](const Point& p) { return toml_text(p.settings); });
        store_.make_folders();
    }
    /// Notes each measuring in a file.
    Measure slow(std::chrono::milliseconds time) const {
        return [this, time](const Point& point) {
            std::ofstream(folder_ / "log", std::ios::app)
                << std::to_string(std::get<std::int64_t>(point.settings.at("samples"))) + "\n";
            std::this_thread::sleep_for(time);
            Result result;
            result.values["error"] = {1};
            return result;
        };
    }
    std::vector<int> log() const {
        std::ifstream in(folder_ / "log");
        std::vector<int> out;
        for (int n = 0; in >> n;)
            out.push_back(n);
        std::sort(out.begin(), out.end());
        return out;
    }
    std::size_t results() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(folder_ / "s" / "results"), {}));
    }
    /// Points measured in a process of its own.
    std::size_t measured_by(Isolated& process) const {
        Ended ended;
        while (!process.has_ended(ended))
            std::this_thread::sleep_for(1ms);
        EXPECT_EQ(ended.signal, "");
        return static_cast<std::size_t>(ended.code);
    }

    razor::TemporaryFolder folder_;
    Store store_{folder_ / "s"};
    std::vector<Point> points_;
    RunOptions options_{"test 1"};
    std::vector<int> each_ = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
};

TEST_F(StudyClaims, TwoAtOnceShareThePoints) {
    const auto work = [&] {
        return static_cast<int>(run_points(points_, store_, slow(20ms), options_).measured);
    };
    Isolated first(work), second(work);
    const std::size_t one = measured_by(first), two = measured_by(second);
    EXPECT_EQ(one + two, 12U);
    EXPECT_GT(one, 0U);
    EXPECT_GT(two, 0U);
    EXPECT_EQ(log(), each_); // none twice
    EXPECT_EQ(results(), 12U);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "s" / "claims"));
}

TEST_F(StudyClaims, JobsRunSideBySide) {
    options_.jobs = 4;
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(run_points(points_, store_, slow(500ms), options_).measured, 12U);
    const auto time = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(time, 4500ms); // 12 of them after each other take 6000
    EXPECT_GE(time, 1500ms);
    EXPECT_EQ(log(), each_);
}

// Whoever is killed leaves claims, and no results of what it was at; others take these at once.
TEST_F(StudyClaims, GoOnAfterAKill) {
    options_.jobs = 3;
    const pid_t child = fork();
    if (child == 0) {
        run_points(points_, store_, slow(100s), options_);
        _exit(0);
    }
    while (log().size() < 3)
        std::this_thread::sleep_for(1ms);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "s" / "claims"), {}), 3);
    EXPECT_EQ(results(), 0U);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(run_points(points_, store_, slow(1ms), options_).measured, 12U);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
    EXPECT_EQ(results(), 12U);
}

TEST_F(StudyClaims, OthersAreWaitedFor) {
    Claims others(store_);
    ASSERT_TRUE(others.take(points_[4]));
    Claims again(store_);
    EXPECT_FALSE(again.take(points_[4])); // this process is alive
    Isolated run([&] { return static_cast<int>(run_points(points_, store_, slow(1ms), options_).measured); });
    while (results() < 11)
        std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(200ms);
    EXPECT_EQ(results(), 11U); // all but that one
    others.release(points_[4]);
    EXPECT_EQ(measured_by(run), 12U);
    EXPECT_EQ(log(), each_);
    // Of another host nothing is known but that it touches its claims.
    std::filesystem::create_directories(folder_ / "s" / "claims"); // gone with the last claim
    std::ofstream(folder_ / "s" / "claims" / points_[0].name) << "elsewhere 1\n";
    EXPECT_FALSE(again.take(points_[0]));
    EXPECT_TRUE(again.take(points_[1]));
}

} // namespace
} // namespace analysis
