// What razor-sim shows of a machine's calibration, and the program whose kernels are counted for it.
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

namespace razor {
namespace {

const std::string simulator = quoted_argument(RAZOR_SIMULATOR) +
                              " run --quiet --no-native --size 8x8 --spp 1 --light-samples 1 --sky-samples 1 "
                              "--edge-pixels 16 --workers 1 ";
const std::string tiny = RAZOR_SOURCE_DIR "/configs/machines/tiny.toml";

class Calibration : public ::testing::Test {
protected:
    /// Runs the machine m.toml, tiny with this calibration (none: empty).
    Outcome simulate(const std::string& calibration, const std::string& options = "") const {
        folder_.file("m.toml", "inherit = \"" + tiny + "\"\n" + calibration);
        return run(simulator + "--machine m.toml --json report.json " + options, folder_.path());
    }
    nlohmann::json report() const {
        std::ifstream file(folder_ / "report.json", std::ios::binary);
        return nlohmann::json::parse(file);
    }
    TemporaryFolder folder_;
};

const std::string named = "calibration = \"c.json\"\n";
const char* const written = R"({"target": "sse4", "frame": "--size 64x64", "build": "by x 1.2",
 "settings": {"core.lanes": 8, "core.gather": "line", "core.scalar_overhead": 0.5},
 "kernels": [
  {"kernel": "build", "share": 0.25, "instructions": {"ratio": 1.104, "within": true, "fitted": true},
   "references": {"ratio": 0.5, "within": false, "fitted": true}},
  {"kernel": "light", "share": 0.75, "instructions": {"ratio": 0.96, "within": true, "fitted": true},
   "references": {"ratio": 0.5, "within": false, "fitted": false}}]})";

TEST_F(Calibration, IsShownByKernel) {
    folder_.file("c.json", written);
    const Outcome o = simulate(named);
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(
        o.out.find("counts beside those of the kernels' sse4 build, of the frame --size 64x64 (c.json)\n"),
        std::string::npos);
    EXPECT_NE(o.out.find("  build            25.0 %         +10 %        -50 %!\n"), std::string::npos)
        << o.out;
    EXPECT_NE(o.out.find("  light            75.0 %          -4 %        -50 %*\n"), std::string::npos);
    EXPECT_NE(o.out.find("\n  !: farther off"), std::string::npos);
    EXPECT_NE(o.out.find("\n  *: valgrind"), std::string::npos);
    const nlohmann::json shown = report().at("calibration");
    EXPECT_EQ(shown.at("differs"), "");
    EXPECT_EQ(shown.at("build"), "by x 1.2");
    ASSERT_EQ(shown.at("kernels").size(), 2U);
    EXPECT_EQ(shown.at("kernels")[0].at("instructions").at("ratio"), 1.104);
    EXPECT_EQ(shown.at("kernels")[1].at("references").at("fitted"), false);
}

TEST_F(Calibration, OfAnotherMachineIsNotShown) {
    folder_.file("c.json", written);
    const Outcome o = simulate(named, "-g core.lanes=4");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("calibration            none: core.lanes is 4, not 8 where c.json was made\n"),
              std::string::npos);
    EXPECT_EQ(o.out.find("  build            25.0 %"), std::string::npos);
    EXPECT_EQ(report().at("calibration").at("differs"), "core.lanes is 4, not 8");
    ASSERT_EQ(simulate("").code, 0);
    EXPECT_FALSE(report().contains("calibration"));
    ASSERT_EQ(simulate(named, "--no-calibration").code, 0);
    EXPECT_FALSE(report().contains("calibration"));
}

TEST_F(Calibration, ThatIsMissingOrBrokenIsOneLine) {
    const auto refused = [&](const std::string& text, const std::string& why) {
        if (!text.empty())
            folder_.file("c.json", text);
        const Outcome o = simulate(named);
        EXPECT_EQ(o.code, 2);
        EXPECT_EQ(o.error_lines(), 1) << o.err;
        EXPECT_NE(o.err.find("c.json: " + why), std::string::npos) << o.err;
        EXPECT_NE(o.err.find("; make it anew with analysis/calibration/calibrate.py -o\n"),
                  std::string::npos);
        EXPECT_FALSE(std::filesystem::exists(folder_ / "report.json"));
    };
    refused("", "the calibration of m.toml cannot be read");
    refused("{", "is no calibration: ");
    refused("{}", "is no calibration: ");
    const std::string good = written;
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        return text.replace(text.find(from), from.size(), to);
    };
    refused(with("1.104", "0"), "is no calibration: a ratio is not above zero");
    refused(with("1.104", "\"much\""), "is no calibration: ");
    refused(with("core.lanes", "core.lames"), "is no calibration: there is no setting core.lames");
    const Outcome o = simulate("calibration = 3\n");
    EXPECT_EQ(o.code, 2);
    EXPECT_EQ(o.err, "razor-sim: m.toml:2:15: calibration must be the name of a file in quotes, written by "
                     "analysis/calibration/calibrate.py -o\n");
}

TEST_F(Calibration, OfShippedMachinesIsTheirs) {
    int calibrated = 0;
    for (const auto& entry : std::filesystem::directory_iterator(RAZOR_SOURCE_DIR "/configs/machines")) {
        std::ifstream file(entry.path());
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        if (text.find("\ncalibration = ") == std::string::npos)
            continue;
        const Outcome o =
            run(simulator + "--json report.json --machine " + quoted_argument(entry.path().string()),
                folder_.path());
        ASSERT_EQ(o.code, 0) << o.err;
        EXPECT_EQ(report().at("calibration").at("differs"), "") << entry.path();
        ++calibrated;
    }
    EXPECT_GE(calibrated, 2);
}

TEST_F(Calibration, CountsTheFrameThatIsRendered) {
    const std::string frame = "--isa sse4 --size 24x16 --spp 1 -o ";
    const Outcome counted = run(quoted_argument(RAZOR_NATIVE_FRAME) + " " + frame + "a.exr", folder_.path());
    if (counted.code == 2 && counted.err.find("--isa sse4") != std::string::npos)
        GTEST_SKIP() << "this build or processor has no sse4";
    ASSERT_EQ(counted.code, 0) << counted.err;
    EXPECT_EQ(counted.out.rfind(ISA_WIDTH_TEXT " lanes of sse4, compiler ", 0), 0U) << counted.out;
    const std::string razor = quoted_argument(RAZOR_PROGRAM);
    ASSERT_EQ(run(razor + " render --quiet --threads 1 " + frame + "b.exr", folder_.path()).code, 0);
    EXPECT_EQ(run(razor + " compare --identical a.exr b.exr", folder_.path()).code, 0);
    const Outcome small =
        run(quoted_argument(RAZOR_NATIVE_FRAME) + " --arena 0 " + frame + "c.exr", folder_.path());
    EXPECT_EQ(small.code, 2);
    EXPECT_EQ(small.error_lines(), 1);
}

} // namespace
} // namespace razor
