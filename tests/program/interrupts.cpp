// razor export-mesh, interrupted: it says so and leaves nothing.
#include "tests/program/run.h"

namespace razor {
namespace {

/// Sends the signals, once `until` holds, to an export that writes for long.
Outcome interrupted(const TemporaryFolder& folder, const std::string& until, const std::string& signals) {
    folder.file("s.toml", "[settings]\nsize = [160, 160]\nedge_pixels = 0.3\n[[mesh]]\nshape = \"gear\"\n");
    const std::string command =
        quoted_argument(RAZOR_PROGRAM) + " export-mesh s.toml -o out.obj & pid=$!; until " + until +
        "; do sleep 0.01; done; for s in " + signals + "; do kill -$s $pid; done; wait $pid";
    return run("bash -c " + quoted_argument(command), folder.path());
}

void expect_nothing(const TemporaryFolder& folder, const Outcome& result) {
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_EQ(folder.count(), 1U) << "s.toml";
}

/// A file of no name yet, or of a temporary one.
const std::string is_writing = "ls -l /proc/$pid/fd 2> /dev/null | grep -q \"$PWD/[#.]\"";

TEST(Interrupts, ExportThatWritesLeavesNothing) {
    for (const char* signal : {"INT", "TERM"}) {
        const TemporaryFolder folder;
        const Outcome result = interrupted(folder, is_writing, signal);
        expect_nothing(folder, result);
        EXPECT_EQ(result.err, "razor: interrupted; nothing written\n") << signal;
    }
}

TEST(Interrupts, ASecondSignalLeavesNoHalfFile) {
    const TemporaryFolder folder;
    expect_nothing(folder, interrupted(folder, is_writing, "INT INT TERM"));
}

TEST(Interrupts, ExportThatHasNotBegunToWrite) {
    const TemporaryFolder folder;
    expect_nothing(folder, interrupted(folder, "sleep 0.2", "INT"));
}

} // namespace
} // namespace razor
