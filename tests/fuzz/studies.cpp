// Study files: any text is points of known settings or one clear line.
#include "analysis/study/error.h"
#include "tests/analysis/study_parts.h"
#include "tests/fuzz/target.h"

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        "kind = \"test\"\ntitle = \"t\"\nseeds = 2\nrepeats = 2\n[settings]\nscene = "
        "\"a\"\n[reference]\nsamples = "
        "100\n[knobs]\n"
        "samples = [1, 2, 4]\nedge = [0.5, 1]\n[[plot]]\nx = \"seconds\"\ny = \"error\"\nlines = "
        "[\"edge\"]\n",
        "kind = \"test\"\n[settings]\nscene = \"a\"\n[[points]]\nlod = [\"x\", \"y\"]\n[[points]]\nl2.size = "
        "[1, 2.5]\n"
        "[full]\nseeds = 9\n",
    };
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    try {
        const analysis::Study study =
            analysis::parse_study(bytes, "fuzz", analysis::test_vocabulary(), bytes.size() % 2 == 0);
        require(study.seeds >= 1 && study.repeats >= 0 && study.points.size() <= analysis::most_points);
    } catch (const analysis::StudyError& error) {
        require_line(error.what());
    }
    return true;
}
