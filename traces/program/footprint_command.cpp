// razor-trace footprint: what threads touch alone, and what several of them do.
#include "analysis/traces/line_use.h"
#include "traces/program/analyses.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Table;
using analysis::Touch;

class FootprintCommand final : public AnalysisCommand {
public:
    FootprintCommand()
        : AnalysisCommand("footprint", "how many bytes are touched by one thread, by two, by n",
                          "structure") {}
    void run() override {
        options_.prepare();
        analysis::LineUse use(options_.line_bytes());
        analysis::Touches touches = options_.touches();
        options_.each_block(
            [&](const Block& block) { touches.each(block, [&](const Touch& t) { use.touch(t); }); });
        const std::uint64_t line = options_.line_bytes();
        Table table;
        if (threads_) {
            table.columns = {"thread",  "lines",       "bytes of lines", "bytes used",
                             "written", "lines alone", "part alone"};
            const std::vector<std::string>& names = options_.description().streams;
            for (const analysis::LineUse::Footprint& f : use.footprints())
                table.rows.push_back(
                    {f.stream < names.size() ? names[f.stream] : fmt::format("thread {}", f.stream), f.lines,
                     f.lines * line, f.bytes, f.written, f.alone, part(f.alone, f.lines)});
        } else {
            table = options_.table({"touched by", "lines", "bytes of lines", "references", "written",
                                    "lines of private caches"});
            for (const analysis::LineUse::Shared& s : use.shared())
                options_.add_row(
                    table, touches, s.group,
                    {s.threads, s.lines, s.lines * line, s.touches, s.written, s.lines * s.threads});
        }
        options_.give("footprint", table,
                      fmt::format("lines of {} bytes{}{}", line, options_.of_sample(),
                                  options_.grouped() && !threads_
                                      ? fmt::format(", by {} of who touched them first", options_.by())
                                      : ""));
    }

private:
    void add_options(CLI::App& app) override {
        app.add_flag("--threads", threads_, "instead, what each thread touches, and what of it alone")
            ->excludes(app.get_option("--by"));
    }
    bool threads_ = false;
};

} // namespace

std::unique_ptr<AnalysisCommand> footprint_command() {
    return std::make_unique<FootprintCommand>();
}

} // namespace traces
