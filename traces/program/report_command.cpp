// razor-trace report: a page about a trace.
#include "analysis/plots/chart.h"
#include "traces/error.h"
#include "traces/program/analyses.h"
#include "traces/program/cache_options.h"
#include "traces/program/report.h"
#include "traces/program/tile_picture.h"
#include "traces/summary.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Access;
using analysis::Table;
using analysis::Touch;

class ReportCommand final : public AnalysisCommand {
public:
    ReportCommand()
        : AnalysisCommand("report", "a page of HTML with charts of all this, of one cache size",
                          "structure") {}
    void run() override {
        if (!output_.ends_with(".html") && !output_.ends_with(".htm"))
            throw Error(fmt::format("-o {}: name a .html file", output_));
        options_.prepare({output_}, {over_});
        options_.refuse_sample();
        options_.refuse_pipe();
        caches_.prepare(options_.line_bytes());
        if (caches_.sizes().size() != 1)
            throw Error("--sizes: a report is of one size; give one");
        const Picture picture = options_.description().picture;
        if (!over_.empty()) {
            options_.require_tiles();
            TilePicture(over_, picture); // which may not be one
        }
        Summary summary;
        std::uint64_t first = ~std::uint64_t{0}, last = 0;
        options_.each_block([&](const Block& block) {
            summary.add(block);
            for (const std::uint64_t time : block.times) {
                first = std::min(first, time);
                last = std::max(last, time);
            }
        });
        if (summary.references() == 0)
            throw Error(fmt::format("{}: holds no references; record some, or give its format by --from",
                                    options_.file()));
        options_.reopen();
        Report report(caches_.shapes()[0], first, last, over_.empty() ? 0 : picture.tiles());
        analysis::Touches touches = options_.touches();
        options_.each_block([&](const Block& block) {
            touches.each(block, [&](const Touch& t) { report.touch(t, caches_.cache_of(t.stream)); });
            touches.each_access(block, [&](const Access& a) { report.access(a); });
        });

        const Description& description = options_.description();
        Report::Names names{
            {},
            options_.grouped() ? options_.by() : "group",
            analysis::short_text(static_cast<double>(caches_.sizes()[0]), analysis::Unit::bytes) + ", " +
                caches_.text()};
        for (std::size_t g = 0; g < touches.groups(); ++g)
            names.groups.push_back(touches.name(g, description));
        analysis::Page page("Memory references of " + options_.file());
        page.paragraph(fmt::format(
            "{} references, times {} to {} ({}), by {}{}; lines of {} bytes.", summary.references(), first,
            last, description.time, description.program.empty() ? "an unknown program" : description.program,
            description.level.empty() ? "" : ", seen at " + description.level, options_.line_bytes()));
        for (const std::string& text : {options_.note(), description.filters})
            if (!text.empty())
                page.paragraph(text);
        if (!over_.empty())
            report.write_tiles(page, over_, names, picture);
        report.write(page, names, description);

        Table table = options_.table({"references", "misses", "ratio"});
        for (std::size_t g = 0; g < report.causes().size(); ++g) {
            const auto& of = report.causes()[g];
            options_.add_row(table, touches, g,
                             {of.references, of.misses(), part(of.misses(), of.references)});
        }
        options_.give("report", table, fmt::format("{}: {}", output_, names.caches), nullptr,
                      {{output_, page.html()}});
    }

private:
    void add_options(CLI::App& app) override {
        app.add_option("-o,--output", output_, "the page, FILE.html; it needs nothing beside it")
            ->type_name("FILE")
            ->required();
        app.add_option("--over", over_,
                       "also draw what each screen tile asked for over this picture, OpenEXR or PNG")
            ->type_name("PICTURE");
        caches_.add_to(app);
    }
    std::string output_, over_;
    CacheOptions caches_{"1", "32KiB"};
};

} // namespace

std::unique_ptr<AnalysisCommand> report_command() {
    return std::make_unique<ReportCommand>();
}

} // namespace traces
