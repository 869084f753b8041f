// razor-trace lines: what becomes of lines: bytes used, sharing, false sharing, the hottest.
#include "analysis/traces/line_use.h"
#include "traces/program/analyses.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Table;
using analysis::Touch;

class LinesCommand final : public AnalysisCommand {
public:
    LinesCommand() : AnalysisCommand("lines", "how much of lines is used, and who shares them", "all") {}
    void run() override {
        options_.prepare();
        analysis::LineUse use(options_.line_bytes());
        analysis::Touches touches = options_.touches();
        options_.each_block(
            [&](const Block& block) { touches.each(block, [&](const Touch& t) { use.touch(t); }); });
        Table table;
        if (hottest_ != 0) {
            table = options_.table({"address", "references", "threads"});
            for (const analysis::LineUse::Line& line : use.hottest(static_cast<std::size_t>(hottest_)))
                options_.add_row(
                    table, touches, line.group,
                    {fmt::format("0x{:x}", line.line * options_.line_bytes()), line.touches, line.threads});
        } else {
            table = options_.table({"lines", "references", "bytes used", "part used", "copies a line",
                                    "shared", "and written", "falsely", "references to those"});
            const std::vector<analysis::LineUse::Group> groups = use.groups();
            for (std::size_t g = 0; g < groups.size(); ++g) {
                const auto& of = groups[g];
                if (of.lines != 0)
                    options_.add_row(
                        table, touches, g,
                        {of.lines, of.touches, of.bytes, part(of.bytes, of.lines * options_.line_bytes()),
                         part(of.copies, of.lines), of.shared, of.written, of.falsely, of.false_touches});
            }
        }
        options_.give("lines", table,
                      fmt::format("lines of {} bytes{}{}", options_.line_bytes(), options_.of_sample(),
                                  options_.grouped()
                                      ? fmt::format(", by {} of who touched them first", options_.by())
                                      : ""));
    }

private:
    void add_options(CLI::App& app) override {
        app.add_option("--hottest", hottest_, "instead, so many lines that are touched most")
            ->type_name("N")
            ->check(CLI::Range(1, 1000000));
    }
    int hottest_ = 0;
};

} // namespace

std::unique_ptr<AnalysisCommand> lines_command() {
    return std::make_unique<LinesCommand>();
}

} // namespace traces
