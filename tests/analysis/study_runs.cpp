// Points are measured once, wherever a study is stopped; what fails or crashes is a result that says so.
#include "analysis/study/error.h"
#include "analysis/study/isolated.h"
#include "analysis/study/run.h"
#include "tests/analysis/study_parts.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>
#include <unistd.h>

namespace analysis {
namespace {

class StudyRun : public ::testing::Test {
protected:
    StudyRun() {
        const Study study = test_study("kind = \"test\"\n[knobs]\nsamples = [1, 2, 3, 4, 5]\n");
        points_ = resolve_points(study, [](const Point& p) { return toml_text(p.settings); });
    }
    static std::int64_t samples(const Point& point) {
        return std::get<std::int64_t>(point.settings.at("samples"));
    }
    /// Notes each measuring in a file, as it happens in another process.
    Result measured(const Point& point) const {
        std::ofstream(folder_ / "log", std::ios::app) << samples(point);
        Result result;
        result.values["error"] = {1.0 / static_cast<double>(samples(point))};
        result.host["seconds"] = {
            std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count()};
        return result;
    }
    std::string log() const {
        std::ifstream in(folder_ / "log");
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::string text(const std::filesystem::path& file) const {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::size_t files(const char* part) const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(folder_ / "s" / part), {}));
    }

    razor::TemporaryFolder folder_;
    Store store_{folder_ / "s"};
    std::vector<Point> points_;
    RunOptions options_{"test 1", nullptr, false, 1, 1, {}};
};

TEST_F(StudyRun, GoesOnWhereItWasStopped) {
    std::atomic<bool> stop{false};
    options_.stop = &stop;
    options_.progress = [&](std::size_t, std::size_t, const Point& next) {
        if (samples(next) == 3)
            stop = true; // as by a signal, while the third is measured
    };
    const Measure measure = [this](const Point& point) {
        if (samples(point) == 3)
            for (;;) // until it is told to end
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return measured(point);
    };
    const RunSummary first = run_points(points_, store_, measure, options_);
    EXPECT_TRUE(first.stopped);
    EXPECT_EQ(first.measured, 2U);
    EXPECT_EQ(log(), "12");
    EXPECT_EQ(files("results"), 2U); // nothing of the third
    options_.stop = nullptr;
    options_.progress = {};
    const RunSummary second = run_points(
        points_, store_, [this](const Point& point) { return measured(point); }, options_);
    EXPECT_FALSE(second.stopped);
    EXPECT_EQ(second.measured, 3U);
    EXPECT_EQ(second.kept, 2U);
    EXPECT_EQ(log(), "12345"); // each once
    EXPECT_EQ(files("results"), 5U);
    EXPECT_EQ(files("points"), 5U);
    EXPECT_EQ(text(folder_ / "s" / "points" / (points_[3].name + ".toml")), "samples = 4\n");
}

TEST_F(StudyRun, FailuresAreResultsAndDoNotStopOthers) {
    points_[4].impossible = "five cannot be";
    const Measure measure = [this](const Point& point) -> Result {
        if (samples(point) == 2)
            throw std::runtime_error("two is wrong");
        if (samples(point) == 3) {
            std::signal(SIGSEGV, SIG_DFL); // sanitizers have handlers of their own
            ::raise(SIGSEGV);
        }
        return measured(point);
    };
    const RunSummary summary = run_points(points_, store_, measure, options_);
    EXPECT_EQ(summary.measured, 5U);
    EXPECT_EQ(summary.failed, 3U);
    EXPECT_EQ(log(), "14");
    EXPECT_EQ(store_.read_result(points_[1])->failed, "two is wrong");
    EXPECT_EQ(store_.read_result(points_[2])->failed, "ended by a signal: Segmentation fault");
    EXPECT_EQ(store_.read_result(points_[4])->failed, "five cannot be");
    EXPECT_EQ(store_.read_result(points_[3])->values.at("error"), std::vector<double>{0.25});
    // They stay so, until it is asked for.
    const Measure now = [this](const Point& point) { return measured(point); };
    EXPECT_EQ(run_points(points_, store_, now, options_).measured, 0U);
    options_.again_failed = true;
    points_[4].impossible = "";
    EXPECT_EQ(run_points(points_, store_, now, options_).measured, 3U);
    EXPECT_EQ(log(), "14235");
    EXPECT_EQ(store_.read_result(points_[2])->failed, "");
}

TEST_F(StudyRun, EqualPointsAreEqualBytesApartFromTimes) {
    const Store other(folder_ / "t");
    const Measure measure = [this](const Point& point) { return measured(point); };
    run_points(points_, store_, measure, options_);
    run_points(points_, other, measure, options_);
    for (const Point& point : points_) {
        const std::string a = text(folder_ / "s" / "results" / (point.name + ".json")),
                          b = text(folder_ / "t" / "results" / (point.name + ".json"));
        EXPECT_NE(a, b); // the clock
        EXPECT_EQ(a.substr(0, a.find("\"host\"")), b.substr(0, b.find("\"host\"")));
        EXPECT_NE(a.find("\"host\""), std::string::npos);
    }
}

TEST_F(StudyRun, PartsShareThePoints) {
    const Measure measure = [this](const Point& point) { return measured(point); };
    options_.parts = 2;
    options_.part = 2;
    EXPECT_EQ(run_points(points_, store_, measure, options_).measured, 2U);
    EXPECT_EQ(log(), "24");
    options_.part = 1;
    EXPECT_EQ(run_points(points_, store_, measure, options_).measured, 3U);
    EXPECT_EQ(log(), "24135");
}

TEST_F(StudyRun, DamagedResultsAreSaidToBe) {
    run_points(
        points_, store_, [this](const Point& point) { return measured(point); }, options_);
    const std::filesystem::path file = folder_ / "s" / "results" / (points_[0].name + ".json");
    const std::string whole = text(file);
    EXPECT_THROW(
        {
            std::ofstream(file) << whole.substr(0, whole.size() / 2);
            store_.read_result(points_[0]);
        },
        StudyError);
    std::ofstream(file) << text(folder_ / "s" / "results" / (points_[1].name + ".json"));
    EXPECT_THROW(store_.read_result(points_[0]), StudyError);
    EXPECT_THROW(Store(file / "under").make_folders(), StudyError);
    std::ofstream(file) << "{";
    try {
        store_.read_result(points_[0]);
    } catch (const StudyError& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find(": is damaged; remove " + file.string()), std::string::npos) << what;
        EXPECT_EQ(what.find("json.exception"), std::string::npos) << what;
    }
}

TEST_F(StudyRun, KeepsNothingOfFilesThatChanged) {
    options_.changed = [](const Point& point) {
        return samples(point) == 1 ? std::string() : std::string("machine.toml");
    };
    const Measure measure = [this](const Point& point) {
        if (samples(point) == 3)
            throw std::runtime_error("its reference is gone"); // as for a change
        return measured(point);
    };
    const auto message = [&] {
        try {
            run_points(points_, store_, measure, options_);
        } catch (const StudyError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_TRUE(message().starts_with("machine.toml: was changed while the study ran")) << message();
    EXPECT_EQ(files("results"), 1U);
    std::swap(points_[1], points_[2]);
    EXPECT_TRUE(message().starts_with("machine.toml: was changed while the study ran")) << message();
    EXPECT_EQ(files("results"), 1U);
}

TEST_F(StudyRun, SaysOnceWhatCannotBeWritten) {
    const Measure measure = [this](const Point& point) {
        std::filesystem::remove_all(folder_ / "s" / "results");
        std::ofstream(folder_ / "s" / "results") << "no folder";
        return measured(point);
    };
    testing::internal::CaptureStderr();
    EXPECT_THROW(run_points(points_, store_, measure, options_), StudyError);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// Waiting ends with the child, neither before nor long after.
TEST(StudyRuns, WaitsForAChildAsLongAsItTakes) {
    for (int i = 0; i < 3; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        Isolated child([] {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            return 7;
        });
        ChildrenEnd({child.process()}).wait(60000);
        Ended how;
        EXPECT_TRUE(child.has_ended(how));
        EXPECT_EQ(how.code, 7);
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
        ChildrenEnd({}).wait(1); // nobody: as long as was said
    }
}

} // namespace
} // namespace analysis
