// razor study: small studies of a box, gone on with, interrupted, with rivals and mistakes.
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <map>

namespace razor {
namespace {

namespace fs = std::filesystem;

constexpr const char* small_study = R"(
kind = "image"
title = "A pawn"
seeds = 3
repeats = 1
[settings]
scene = "pawn.toml"
size = "48x32"
threads = 1
[knobs]
edge_pixels = [1, 8]
samples = [1, 4]
[reference]
seeds = 3
samples = 64
lod = "camera"
edge_pixels = 0.25
[[plot]]
x = "seconds"
y = "rmse"
lines = ["edge_pixels"]
)";

class Study : public ::testing::Test {
protected:
    Study() {
        folder_.file("pawn.toml", "[[mesh]]\nshape = \"pawn\"\n");
        folder_.file("study.toml", small_study);
    }
    Outcome study(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " study " + arguments, folder_.path());
    }
    std::string text(const fs::path& file) const {
        std::ifstream in(folder_.path() / file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    nlohmann::json json(const fs::path& file) const { return nlohmann::json::parse(text(file)); }
    /// Everything that lies below, by name, without what stands behind "host".
    std::map<std::string, std::string> results(const fs::path& folder) const {
        std::map<std::string, std::string> out;
        for (const auto& entry : fs::directory_iterator(folder_.path() / folder / "results")) {
            const std::string all = text(entry.path());
            out[entry.path().filename().string()] = all.substr(0, all.find("\"host\""));
        }
        return out;
    }
    std::size_t count(const fs::path& folder) const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path() / folder), {}));
    }

    TemporaryFolder folder_;
};

TEST_F(Study, MeasuresErrorsAndTimes) {
    const Outcome first = study("study.toml -o s");
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_EQ(first.err, ""); // no progress in a pipe
    EXPECT_NE(first.out.find("4 points: 4 measured, 0 failed, 0 missing"), std::string::npos) << first.out;
    const nlohmann::json all = json("s/study.json");
    std::map<std::pair<double, int>, nlohmann::json> at;
    for (const auto& point : all["points"])
        at[{point["settings"]["edge_pixels"], point["settings"]["samples"]}] = point["figures"];
    const auto of = [&](double edge, int samples, const char* figure) {
        return at.at({edge, samples}).at(figure).at("median").get<double>();
    };
    // Four times the samples: half the noise or less, the bias no other; edges eight times as long: the other
    // way.
    EXPECT_LT(of(1, 4, "noise"), 0.65 * of(1, 1, "noise"));
    EXPECT_NEAR(of(8, 4, "noise"), of(1, 4, "noise"), 0.3 * of(1, 4, "noise"));
    EXPECT_GT(of(8, 4, "level_bias"), 2 * of(1, 4, "level_bias"));
    EXPECT_NEAR(of(8, 1, "level_bias"), of(8, 4, "level_bias"), 0.3 * of(8, 4, "level_bias"));
    EXPECT_GT(of(8, 4, "distance_error"), 5 * of(1, 4, "distance_error"));
    EXPECT_EQ(of(1, 4, "samples_taken"), 4);
    // rmse^2 is both together, of what the reference's noise adds little to.
    const double rmse = of(8, 4, "rmse"), noise = of(8, 4, "noise"), bias = of(8, 4, "bias");
    EXPECT_NEAR(rmse * rmse, noise * noise + bias * bias, 0.15 * rmse * rmse);
    for (const char* figure :
         {"seconds", "first_seconds", "processor_seconds", "flip", "mape", "relative_mse"})
        EXPECT_EQ(at.at({1, 1}).at(figure).at("count"), 3) << figure;
    for (const char* file : {"s/study.csv", "s/study.html", "s/rmse-seconds.svg", "s/rmse-seconds.png"})
        EXPECT_FALSE(text(file).empty()) << file;

    // All is kept: nothing is measured again.
    const auto before = results("s");
    const auto written = fs::last_write_time(folder_.path() / "s/results" / before.begin()->first);
    ASSERT_EQ(study("study.toml -o s").code, 0);
    EXPECT_EQ(fs::last_write_time(folder_.path() / "s/results" / before.begin()->first), written);
    // Elsewhere the same points have the same bytes, apart from times.
    ASSERT_EQ(study("study.toml -o t").code, 0);
    EXPECT_EQ(results("t"), before);
    // What the scene holds is part of a point.
    folder_.file("pawn.toml", "[[mesh]]\nshape = \"pawn\"\nscale = [1, 2, 1]\n");
    ASSERT_EQ(study("study.toml -o t").code, 0);
    EXPECT_EQ(results("t").size(), 2 * before.size());
}

TEST_F(Study, GoesOnWhereItWasInterrupted) {
    std::string longer = small_study;
    longer.replace(longer.find("samples = [1, 4]"), 16, "samples = [1, 4, 2000]");
    folder_.file("long.toml", longer);
    // Nine pictures to compare with are made fast, the next one takes long: the signal comes while it is
    // rendered.
    const std::string command = quoted_argument(RAZOR_PROGRAM) +
                                " study long.toml -o s & pid=$!; while [ $(ls s/results 2>/dev/null | wc -l) "
                                "-lt 9 ]; do sleep 0.05; done; sleep 0.3; kill -INT $pid; wait $pid";
    const Outcome stopped = run("bash -c " + quoted_argument(command), folder_.path());
    EXPECT_EQ(stopped.code, 130) << stopped.err;
    EXPECT_NE(stopped.err.find("interrupted; what was measured is in s"), std::string::npos) << stopped.err;
    const auto whole = results("s");
    for (const auto& [name, all] : whole)
        EXPECT_NO_THROW(static_cast<void>(json(fs::path("s/results") / name))) << name;
    EXPECT_FALSE(fs::exists(folder_ / "s/study.csv"));
    // What is there already is what the shorter study needs of it.
    const Outcome rest = study("study.toml -o s");
    EXPECT_EQ(rest.code, 0) << rest.err;
    EXPECT_NE(rest.out.find("4 points: 4 measured"), std::string::npos);
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
        EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
}

TEST_F(Study, TakesRivalsAndSaysWhatFails) {
    // A program that draws everything black, and one that is not there.
    folder_.file("rival.sh",
                 "printf '{\"runs\": [{\"s\": 1.5}, {\"s\": 2.5}]}' > $2; "
                 "exec " +
                     quoted_argument(RAZOR_PROGRAM) +
                     " render $1 --size $4 --spp 1 --light-samples 0 --sky-samples 0 --lod fixed:$5 -o $3\n");
    folder_.file("rivals.toml", std::string(small_study) + R"(
[[rival]]
name = "black"
command = ["sh", "rival.sh", "{scene}", "{json}", "{picture}", "{size}", "{level}"]
figures = { seconds = "/runs/*/s" }
knobs = { level = [1, 2] }
[[rival]]
name = "absent"
command = ["./no-such-program", "{scene}"]
[[rival]]
name = "wordless"
command = ["sh", "{nothing}"]
)");
    const Outcome outcome = study("rivals.toml -o s");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("8 points: 6 measured, 2 failed, 0 missing"), std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.out.find("./no-such-program: cannot be run"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("{nothing} stands for nothing; there are"), std::string::npos) << outcome.out;
    const nlohmann::json all = json("s/study.json");
    int rivals = 0;
    for (const auto& point : all["points"])
        if (point["rival"] == "black" && point["state"] == "measured") {
            ++rivals;
            EXPECT_EQ(point["figures"]["seconds"]["median"], 2);
            EXPECT_EQ(point["figures"]["seconds"]["count"], 2); // one run: its command names no seed
            EXPECT_GT(point["figures"]["rmse"]["median"], 0.01);
            EXPECT_FALSE(point["figures"].contains("noise"));
        }
    EXPECT_EQ(rivals, 2);
    EXPECT_NE(text("s/rmse-seconds.svg").find(">black</text>"), std::string::npos);
}

TEST_F(Study, PlansPartsAndFullSizes) {
    const Outcome plan = study("study.toml -o s --plan");
    EXPECT_EQ(plan.code, 0) << plan.err;
    EXPECT_EQ(std::count(plan.out.begin(), plan.out.end(), '\n'), 4);
    EXPECT_FALSE(fs::exists(folder_ / "s"));
    const Outcome part = study("study.toml -o s --part 2/4");
    EXPECT_EQ(part.code, 0) << part.err;
    EXPECT_NE(part.out.find("4 points: 1 measured, 0 failed, 3 missing"), std::string::npos) << part.out;
    EXPECT_NE(text("s/study.csv").find("missing"), std::string::npos);
}

TEST_F(Study, RefusesMistakesWithOneLine) {
    const std::pair<const char*, const char*> cases[] = {
        {"kind = \"image\"\n[knobs]\nsample = [1]\n",
         "bad.toml:3:11: unknown setting sample; did you mean samples?"},
        {"kind = \"image\"\n[knobs]\nlod = [\"recursiv\"]\n",
         "bad.toml:3:8: lod = \"recursiv\" is not possible; write one of"},
        {"kind = \"image\"\n[knobs]\nsamples = [0]\n",
         "bad.toml:3:12: samples = 0 is not possible; write a whole number"},
        {"kind = \"image\"\n[knobs]\nmemory = [\"1\"]\n", "bad.toml:3:11: memory '1' is not possible"},
        {"kind = \"image\"\n[settings]\ncrop = \"0,0,8\"\n[knobs]\nsamples = [1]\n",
         "bad.toml:3:8: crop '0,0,8' is not possible; give four whole numbers"},
        {"kind = \"image\"\n[knobs]\ncrop = [\"0,0,8,8\", \"0,0,0,8\"]\n",
         "bad.toml:3:20: crop '0,0,0,8' has no pixels; give X,Y,WIDTH,HEIGHT"},
        {"kind = \"image\"\n[knobs]\nthreads = [0.5]\n", "bad.toml:3:12: threads = 0.5 is not possible"},
        {"kind = \"machine\"\n[knobs]\nsamples = [1]\n", "use the program that measures others"},
    };
    for (const auto& [content, says] : cases) {
        SCOPED_TRACE(content);
        folder_.file("bad.toml", content);
        const std::size_t before = folder_.count();
        const Outcome result = study("bad.toml -o s");
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before);
    }
    EXPECT_EQ(study("none.toml").code, 2);
    // What must fit together is told of one of the lines that say it.
    folder_.file("bad.toml", "kind = \"image\"\n[settings]\nsize = \"8x8\"\n[knobs]\ncrop = [\"0,0,4,4\", "
                             "\"4,4,8,8\"]\n");
    EXPECT_NE(study("bad.toml --plan").out.find("impossible: bad.toml:5:20: crop: the crop of 8 x 8 pixels"),
              std::string::npos)
        << study("bad.toml --plan").out;
    EXPECT_EQ(study("study.toml --part 3/2").code, 2);
    folder_.file("bad.toml", "kind = \"image\"\n[knobs]\nsamples = [1]\n");
    EXPECT_EQ(
        study("bad.toml --full --plan").err,
        "razor: bad.toml: has no [full], the size that --full asks for; leave --full out, or write one\n");
    folder_.file("none.toml", "[[mesh]]\nfile = \"none.obj\"\n");
    // What no single value shows is a point that fails.
    folder_.file("bad.toml", "kind = \"image\"\n[settings]\nsize = \"8x8\"\n[knobs]\nscene = [\"pawn.toml\", "
                             "\"none.toml\"]\nsamples = 1\n");
    const Outcome failed = study("bad.toml -o s");
    EXPECT_EQ(failed.code, 0) << failed.err;
    EXPECT_NE(failed.out.find("2 points: 1 measured, 1 failed"), std::string::npos) << failed.out;
    EXPECT_NE(failed.out.find("none.obj"), std::string::npos) << failed.out;
}

// As they are shipped: their points are possible.
TEST_F(Study, ShippedStudiesArePossible) {
    int images = 0;
    for (const auto& entry : fs::directory_iterator(RAZOR_SOURCE_DIR "/configs/studies")) {
        std::ifstream in(entry.path());
        const std::string content{std::istreambuf_iterator<char>(in), {}};
        if (content.find("kind = \"image\"") == std::string::npos)
            continue;
        ++images;
        for (const char* size : {"", " --full"}) {
            const Outcome plan = study(quoted_argument(entry.path().string()) + " --plan -o s" + size);
            EXPECT_EQ(plan.code, 0) << plan.err;
            EXPECT_EQ(plan.out.find("impossible"), std::string::npos) << plan.out;
            EXPECT_GT(std::count(plan.out.begin(), plan.out.end(), '\n'), 8);
        }
    }
    EXPECT_GE(images, 3);
}

} // namespace
} // namespace razor
