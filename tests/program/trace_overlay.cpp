// From a rendered frame to misses over its picture: the table, the drawing and the page; mistakes leave no
// file.
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

namespace razor {
namespace {

class TraceOverlay : public ::testing::Test {
protected:
    TraceOverlay() {
        folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
        const Outcome made = run(quoted_argument(RAZOR_PROGRAM) +
                                     " render s.toml --size 32x20 --spp 1 --light-samples 1 "
                                     "--sky-samples 1 --threads 2 --quiet --trace a.rzt -o a.png -o a.exr",
                                 folder_.path());
        EXPECT_EQ(made.code, 0) << made.err;
    }
    Outcome tool(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_TRACE) + " " + arguments, folder_.path());
    }
    nlohmann::json rows(const std::string& arguments) const {
        const Outcome result = tool(arguments + " --json -");
        EXPECT_EQ(result.code, 0) << result.err;
        return nlohmann::json::parse(result.out).at("rows");
    }
    std::string text(const std::string& name) const {
        std::ifstream file(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    TemporaryFolder folder_;
};

/// Twelve tiles, each with what filters and other commands say of it, and in all what the whole trace has.
TEST_F(TraceOverlay, TilesHaveWhatOtherCommandsSayOfThem) {
    const nlohmann::json tiles = rows("tiles a.rzt --sizes 8KiB"),
                         causes = rows("causes a.rzt --sizes 8KiB --share 1 --by tile"),
                         all = rows("causes a.rzt --sizes 8KiB --share 1 --by all");
    ASSERT_EQ(tiles.size(), 13U); // and what was for none
    std::uint64_t references = 0, misses = 0;
    for (const nlohmann::json& row : tiles) {
        references += row.at("references").get<std::uint64_t>();
        misses += row.at("misses").get<std::uint64_t>();
        EXPECT_GT(row.at("references"), 0) << row;
        const auto found = std::find_if(causes.begin(), causes.end(), [&](const nlohmann::json& c) {
            return c.at("tile") == row.at("tile");
        });
        ASSERT_NE(found, causes.end()) << row;
        EXPECT_EQ(found->at("references"), row.at("references"));
        EXPECT_EQ(found->at("misses"), row.at("misses"));
        EXPECT_EQ(found->at("compulsory"), row.at("first"));
        if (row.at("tile") == "none")
            continue;
        std::uint64_t filtered = 0;
        for (const nlohmann::json& line :
             rows("causes a.rzt --sizes 8KiB --tile " + row.at("tile").get<std::string>()))
            filtered += line.at("references").get<std::uint64_t>();
        EXPECT_EQ(filtered, row.at("references"));
    }
    EXPECT_EQ(references, all.at(0).at("references"));
    EXPECT_EQ(misses, all.at(0).at("misses"));
    const nlohmann::json info = nlohmann::json::parse(tool("info a.rzt --json").out).at("screen_tiles");
    EXPECT_EQ(info.at("referenced"), 12);
    EXPECT_EQ(info.at("width"), 32);
    EXPECT_EQ(info.at("height"), 20);
}

TEST_F(TraceOverlay, FiguresAreLaidOverThePicture) {
    for (const char* picture : {"a.png", "a.exr"})
        for (const char* figure : {"misses", "bytes", "ratio --linear", "references --range 1,100000"}) {
            const Outcome result =
                tool(std::string("tiles a.rzt --over ") + picture + " -o o.png --figure " + figure);
            EXPECT_EQ(result.code, 0) << result.err;
            EXPECT_TRUE(text("o.png").starts_with("\x89PNG"));
        }
    const Outcome drawn = tool("tiles a.rzt --over a.png -o o.svg");
    EXPECT_EQ(drawn.code, 0) << drawn.err;
    const std::string svg = text("o.svg");
    EXPECT_NE(svg.find("misses of a tile"), std::string::npos);
    EXPECT_TRUE(svg.starts_with("<?xml"));
    EXPECT_EQ(svg.find("<?xml", 1), std::string::npos) << "no XML";
    const Outcome page = tool("report a.rzt -o o.html --over a.exr");
    EXPECT_EQ(page.code, 0) << page.err;
    const std::string html = text("o.html");
    for (const char* name :
         {"references of a tile", "misses of a tile", "miss ratio of a tile", "Over the picture"})
        EXPECT_NE(html.find(name), std::string::npos) << name;
    EXPECT_EQ(html.find("<?xml"), std::string::npos);
}

TEST_F(TraceOverlay, OutputsAreNoPictures) {
    const std::string picture = text("a.exr");
    const std::size_t before = folder_.count();
    for (const char* arguments :
         {"tiles a.rzt --over a.exr -o o.svg --csv a.exr", "tiles a.rzt --over a.png -o ./a.png",
          "report a.rzt --over a.exr -o o.html --csv a.exr", "overlay a.png -o a.png"}) {
        const Outcome result = tool(arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find("is read; name another output"), std::string::npos) << result.err;
        EXPECT_EQ(text("a.exr"), picture) << arguments;
        EXPECT_EQ(folder_.count(), before) << arguments;
    }
}

TEST_F(TraceOverlay, MistakesAreALineAndLeaveNothing) {
    ASSERT_EQ(run(quoted_argument(RAZOR_PROGRAM) + " render s.toml --size 16x16 --spp 1 --quiet -o small.png",
                  folder_.path())
                  .code,
              0);
    const std::size_t before = folder_.count();
    for (const auto& [arguments, cause] : std::vector<std::pair<std::string, std::string>>{
             {"tiles a.rzt --over small.png -o o.png",
              "has 16 x 16 pixels, and the trace is of a picture of 32 x 20"},
             {"report a.rzt --over small.png -o o.html", "has 16 x 16 pixels"},
             {"tiles a.rzt --over no.png -o o.png", "no.png"},
             {"tiles a.rzt --over a.rzt -o o.png", "a.rzt"},
             {"tiles a.rzt --over a.png -o o.png --range 5,1", "the lower one first"},
             {"tiles a.rzt --sizes 1KiB,2KiB", "give one"},
             {"causes a.rzt --sizes 1KiB --tile 32,0", "32 x 20 pixels, numbered from 0"},
             {"causes a.rzt --sizes 1KiB --tile 5", "give a pixel as X,Y"},
             {"causes a.rzt --sizes 1KiB --tile 5,6,7", "give a pixel as X,Y"}}) {
        const Outcome result = tool(arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before) << arguments;
    }
}

} // namespace
} // namespace razor
