// razor-trace replicas: how much of what several caches hold is the same.
#include "analysis/plots/table_chart.h"
#include "analysis/traces/replication.h"
#include "traces/program/analyses.h"
#include "traces/program/cache_options.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Table;
using analysis::Touch;

class ReplicasCommand final : public AnalysisCommand {
public:
    ReplicasCommand()
        : AnalysisCommand("replicas", "how many caches hold the same lines at once", "structure") {}
    void run() override {
        options_.prepare();
        options_.refuse_sample();
        caches_.prepare(options_.line_bytes());
        std::vector<analysis::Replication> all(caches_.shapes().begin(), caches_.shapes().end());
        analysis::Touches touches = options_.touches();
        options_.each_block([&](const Block& block) {
            touches.each(block, [&](const Touch& t) {
                const std::uint32_t cache = caches_.cache_of(t.stream);
                for (analysis::Replication& r : all)
                    r.touch(t, cache);
            });
        });
        Table table = options_.table({"bytes", "lines held", "different", "copies a line", "duplicates",
                                      "of what is held", "of all caches"});
        std::uint64_t caches = 0;
        for (std::size_t g = 0; g < touches.groups(); ++g)
            for (std::size_t i = 0; i < all.size(); ++i) {
                caches = all[i].caches();
                const std::vector<analysis::Replication::Group> groups = all[i].groups();
                if (g >= groups.size() || groups[g].copies == 0)
                    continue;
                const auto [copies, lines] = groups[g];
                const double room = static_cast<double>(caches * caches_.shapes()[i].lines());
                options_.add_row(table, touches, g,
                                 {caches_.sizes()[i], copies, lines, copies / lines, copies - lines,
                                  (copies - lines) / copies, (copies - lines) / room});
            }
        options_.give(
            "replicas", table,
            fmt::format("lines of {} bytes{}, in the mean over all touches; {} {}", options_.line_bytes(),
                        options_.grouped() ? fmt::format(", by {} of who touched them first", options_.by())
                                           : "",
                        caches, caches_.text()),
            [&] {
                return analysis::lines_of(table, options_.by_columns(), "bytes", {"copies a line"},
                                          {"size of each cache", analysis::Unit::bytes, true},
                                          {"copies a line"});
            });
    }

private:
    bool draws() const override { return true; }
    void add_options(CLI::App& app) override { caches_.add_to(app); }
    CacheOptions caches_{"1"};
};

} // namespace

std::unique_ptr<AnalysisCommand> replicas_command() {
    return std::make_unique<ReplicasCommand>();
}

} // namespace traces
