// razor-sim's reports: how large the native kernels are.
#include "razor/frame/phases.h"
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace razor {
namespace {

class CodeSizeReport : public ::testing::Test {
protected:
    void SetUp() override {
        folder_.file("patch.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
        const std::string machine =
            quoted_argument(std::string(RAZOR_SOURCE_DIR) + "/configs/machines/tiny.toml");
        outcome_ = run(quoted_argument(RAZOR_SIMULATOR) + " run --machine " + machine +
                           " --scene patch.obj --size 8x8 --spp 1 --quiet --json report.json",
                       folder_.path());
        ASSERT_EQ(outcome_.code, 0) << outcome_.err;
        report_ = nlohmann::json::parse(std::ifstream(folder_ / "report.json"));
    }

    TemporaryFolder folder_;
    Outcome outcome_;
    nlohmann::json report_;
};

std::vector<std::string> native_targets() {
    std::istringstream all(RAZOR_NATIVE_TARGETS);
    return {std::istream_iterator<std::string>(all), {}};
}

// Every kernel of every native target has code, some of it its own; text and JSON say the same.
TEST_F(CodeSizeReport, OfEveryKernelAndTarget) {
    const nlohmann::json& sizes = report_.at("host").at("code_bytes");
    ASSERT_EQ(sizes.size(), native_targets().size());
    std::string all = "all             ";
    for (const std::string& target : native_targets()) {
        const nlohmann::json& size = sizes.at(target);
        ASSERT_EQ(size.size(), phase_count + 1);
        for (const char* phase : phase_names)
            EXPECT_GT(size.at(phase).get<int>(), 100) << target << ' ' << phase;
        int sum = size.at("common").get<int>();
        for (const char* phase : phase_names)
            sum += size.at(phase).get<int>();
        EXPECT_GT(size.at("intersect").get<int>(), size.at("resolve").get<int>()) << target;
        const std::string digits = std::to_string(sum);
        all += std::string(11 - digits.size(), ' ') + digits;
    }
    EXPECT_NE(outcome_.out.find('\n' + all + '\n'), std::string::npos) << outcome_.out;
}

} // namespace
} // namespace razor
