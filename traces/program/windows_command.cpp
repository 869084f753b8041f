// razor-trace windows: what a trace touches and misses over time.
#include "analysis/plots/table_chart.h"
#include "analysis/traces/windows.h"
#include "traces/error.h"
#include "traces/program/analyses.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Table;
using analysis::Touch;

class WindowsCommand final : public AnalysisCommand {
public:
    WindowsCommand() : AnalysisCommand("windows", "what is touched, new and missed over time", nullptr) {}
    void run() override {
        options_.prepare();
        if (!sizes_.empty())
            options_.refuse_sample("leave out --sizes, or record all lines");
        const std::uint64_t length = parse_window("--window", length_);
        const std::vector<std::uint64_t> sizes =
            sizes_.empty() ? std::vector<std::uint64_t>() : parse_sizes("--sizes", sizes_);
        const std::vector<std::uint64_t> lines = lines_of("--sizes", sizes, options_.line_bytes());
        analysis::Windows windows(length, lines);
        analysis::Touches touches = options_.touches();
        options_.each_block([&](const Block& block) {
            touches.each(block, [&](const Touch& t) { windows.touch(t); });
            if (windows.windows().size() > 1000000)
                throw Error(fmt::format(
                    "--window {}: there are more than a million windows; give longer ones", length));
        });
        Table table;
        table.columns = {"begins", "references", "writes", "lines", "bytes", "new lines"};
        for (const std::uint64_t size : sizes)
            table.columns.push_back(fmt::format("misses of {} bytes", size));
        for (const auto& [number, w] : windows.windows()) {
            table.rows.push_back(
                {number * length, w.touches, w.writes, w.lines, w.lines * options_.line_bytes(), w.first});
            table.rows.back().insert(table.rows.back().end(), w.misses.begin(), w.misses.end());
        }
        options_.give("windows", table,
                      fmt::format("windows of {} of the trace's time ({}), lines of {} bytes{}", length,
                                  options_.description().time, options_.line_bytes(), options_.of_sample()),
                      [&] {
                          std::vector<std::string> shown = {"lines", "new lines"};
                          for (const std::uint64_t size : sizes)
                              shown.push_back(fmt::format("misses of {} bytes", size));
                          return analysis::lines_of(table, 0, "begins", shown, {options_.description().time},
                                                    {"in a window"});
                      });
    }

private:
    bool draws() const override { return true; }
    void add_options(CLI::App& app) override {
        app.add_option("--window", length_, "units of the trace's time a window")->type_name("N")->required();
        app.add_option("--sizes", sizes_, "of LRU caches whose misses are counted, as 32KiB,1MiB")
            ->type_name("SIZES");
    }
    std::string length_, sizes_;
};

} // namespace

std::unique_ptr<AnalysisCommand> windows_command() {
    return std::make_unique<WindowsCommand>();
}

} // namespace traces
