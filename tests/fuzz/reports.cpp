// Reports of runs: any bytes compare with themselves without a difference, or are refused in one clear line.
#include "sim/config/error.h"
#include "sim/reports/compare.h"
#include "tests/fuzz/target.h"

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        R"({"program":"razor-sim","scene":"a\nb\n","mode":"fast","options":{"workers":8},"machine":{"l1":{"ways":4},)"
        R"("sim":{"jitter":1}},"cycles":1000,"l1":{"misses":5},"stack":{"busy":10},"host":{"seconds":1},)"
        R"("phases":[{"phase":"traverse","vops":2}],"traffic":[{"structure":"grids","memory_reads":1,"memory_writes":1}]})",
    };
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    static const File file("fuzz.json");
    file.write(bytes);
    try {
        const std::vector<sim::ReportFile> reports{sim::read_report(file.path())};
        const sim::ReportComparison same = sim::compare_reports(reports, reports);
        require(same.settings.empty() && same.scene.empty() && same.all.empty());
        require(!sim::comparison_text(same, 0.01, true).empty() && !sim::comparison_json(same).empty());
    } catch (const sim::ConfigError& error) {
        require_line(error.what(), file.path());
    }
    return true;
}
