// razor render --trace: the lines that a simulated machine touches, for the same screen tiles, the picture
// that any kernels render, the same bytes each time; mistakes leave no file.
#include "tests/program/simulator.h"
#include "traces/reader.h"

#include <map>
#include <set>
#include <tuple>

namespace razor {
namespace {

class FrameTraces : public Simulator {
protected:
    FrameTraces() { folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n"); }

    Outcome razor(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " " + arguments, folder_.path());
    }
    /// Structure, phase, kind of ray, line of 64 bytes, whether it is written, screen tile: each once. (Which
    /// bytes of a line a masked access means, a machine does not note.)
    using Lines =
        std::set<std::tuple<std::string, std::string, std::string, std::uint64_t, bool, std::uint32_t>>;
    Lines lines(const std::string& file) const {
        traces::Reader reader(traces::open_source(folder_ / file));
        Lines out;
        traces::Block block;
        while (reader.next(block)) {
            const traces::Description& d = reader.description();
            for (std::size_t i = 0; i < block.size(); ++i) {
                const traces::Class& c = block.what(i);
                if (c.kind == traces::Kind::prefetch || c.kind == traces::Kind::flush)
                    continue;
                const std::uint64_t last = (block.addresses[i] + c.size - 1) / 64;
                const bool writes = c.kind != traces::Kind::read; // a machine writes through what is released
                for (std::uint64_t line = block.addresses[i] / 64; line <= last; ++line)
                    out.emplace(d.structures[c.structure], d.phases[c.phase], d.work[c.work], line, writes,
                                block.tile(i));
            }
        }
        EXPECT_TRUE(reader.complete()) << reader.note();
        return out;
    }
    const std::string frame = " --size 32x24 --spp 1 --light-samples 1 --sky-samples 1 ";
};

TEST_F(FrameTraces, TouchTheLinesThatAMachineTouches) {
    ASSERT_EQ(razor("render s.toml --threads 1 --quiet --trace a.rzt" + frame).code, 0);
    ASSERT_EQ(simulator("run --scene s.toml --workers 1 --quiet --no-native --report r.txt --trace b.rzt "
                        "-g core.vector_registers=0 --machine " +
                        tiny + frame)
                  .code,
              0);
    const Lines machine = lines("b.rzt"), none = lines("a.rzt");
    EXPECT_GT(none.size(), 2000U);
    std::set<std::uint32_t> tiles;
    for (const auto& line : machine)
        tiles.insert(std::get<5>(line));
    EXPECT_EQ(tiles.size(), 13U); // all of 32 x 24 pixels, and none
    std::map<std::string, std::size_t> differ;
    for (const auto& line : machine)
        if (!none.contains(line))
            ++differ["the machine alone touches " + std::get<0>(line) + ", " + std::get<1>(line)];
    for (const auto& line : none)
        if (!machine.contains(line))
            ++differ["no machine touches " + std::get<0>(line) + ", " + std::get<1>(line)];
    for (const auto& [what, count] : differ)
        ADD_FAILURE() << what << ": " << count;
}

TEST_F(FrameTraces, AreTheSameEachTimeAndSoIsThePicture) {
    ASSERT_EQ(razor("render s.toml --quiet -o plain.exr" + frame).code, 0);
    for (const char* file : {"a", "b"}) {
        const std::string f(file);
        const Outcome result = razor("render s.toml --threads 3 --trace " + f + ".rzt -o " + f +
                                     ".exr --stats " + f + ".json" + frame);
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_NE(result.out.find(" bytes each"), std::string::npos) << result.out;
        EXPECT_EQ(razor("compare --identical plain.exr " + f + ".exr").code, 0);
    }
    EXPECT_TRUE(text("a.rzt") == text("b.rzt"));
    std::set<std::uint32_t> streams;
    traces::Reader reader(traces::open_source(folder_ / "a.rzt"));
    for (traces::Block block; reader.next(block);)
        for (const traces::Segment& s : block.segments)
            streams.insert(s.stream);
    EXPECT_EQ(streams.size(), 3U);
    EXPECT_EQ(reader.description().streams[2], "worker 2");
    EXPECT_NE(reader.description().configuration.find("urchin"), std::string::npos);
}

TEST_F(FrameTraces, UnderABudgetEnd) {
    ASSERT_EQ(razor("render s.toml --quiet -o plain.exr" + frame).code, 0);
    const Outcome result =
        razor("render s.toml --threads 4 --memory 1MiB --quiet --trace a.rzt -o a.exr" + frame);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(razor("compare --identical plain.exr a.exr").code, 0);
}

TEST_F(FrameTraces, MistakesLeaveNoFile) {
    const std::size_t before = folder_.count();
    for (const auto& [options, cause] : std::vector<std::pair<std::string, std::string>>{
             {"--trace a.rzt --frames 0:1", "--trace is of one frame"},
             {"--trace a.rzt --repeat 2", "--trace is of one frame"},
             {"--trace a.rzt --eager", "--trace is of one frame"},
             {"--trace a.rzt --isa avx2", "--trace is of one frame"},
             {"--trace no/a.rzt", "no/a.rzt"},
             {"--trace .", "is a directory"}}) {
        const Outcome result = razor("render s.toml " + options + frame);
        EXPECT_EQ(result.code, 2) << options;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before) << options;
    }
    const Outcome stopped =
        run("timeout --foreground --preserve-status -s INT -k 100 2 " + quoted_argument(RAZOR_PROGRAM) +
                " render s.toml --size 4000x4000 --threads 3 --trace a.rzt",
            folder_.path());
    EXPECT_EQ(stopped.code, 130);
    EXPECT_EQ(stopped.err, "razor: interrupted; nothing written\n");
    EXPECT_EQ(folder_.count(), before);
}

} // namespace
} // namespace razor
