// razor-trace causes: why caches miss.
#include "analysis/plots/table_chart.h"
#include "analysis/traces/miss_causes.h"
#include "traces/program/analyses.h"
#include "traces/program/cache_options.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Table;
using analysis::Touch;

class CausesCommand final : public AnalysisCommand {
public:
    CausesCommand()
        : AnalysisCommand("causes", "why caches miss: first touches, size, sets, sharing, false sharing",
                          "structure") {}
    void run() override {
        options_.prepare();
        options_.refuse_sample();
        caches_.prepare(options_.line_bytes());
        std::vector<analysis::MissCauses> causes(caches_.shapes().begin(), caches_.shapes().end());
        analysis::Touches touches = options_.touches();
        options_.each_block([&](const Block& block) {
            touches.each(block, [&](const Touch& t) {
                const std::uint32_t cache = caches_.cache_of(t.stream);
                for (analysis::MissCauses& c : causes)
                    c.touch(t, cache);
            });
        });
        Table table = options_.table({"bytes", "references", "misses", "ratio", "compulsory", "capacity",
                                      "conflict", "true sharing", "false sharing"});
        for (analysis::MissCauses& c : causes)
            c.finish();
        std::uint64_t references = 0;
        for (std::size_t g = 0; g < touches.groups(); ++g)
            for (std::size_t i = 0; i < causes.size(); ++i) {
                if (g >= causes[i].groups().size()) // met, but never touched
                    continue;
                const analysis::MissCauses::Group& of = causes[i].groups()[g];
                references += i == 0 ? of.references : 0;
                options_.add_row(table, touches, g,
                                 {caches_.sizes()[i], of.references, of.misses(),
                                  part(of.misses(), of.references), of.compulsory, of.capacity, of.conflict,
                                  of.true_sharing, of.false_sharing});
            }
        options_.give("causes", table,
                      fmt::format("{} touches of lines of {} bytes; {}", references, options_.line_bytes(),
                                  caches_.text()),
                      [&] {
                          return analysis::bars_of(
                              table, options_.by_columns() + 1,
                              {"compulsory", "capacity", "conflict", "true sharing", "false sharing"},
                              {"misses"});
                      });
    }

private:
    bool draws() const override { return true; }
    void add_options(CLI::App& app) override { caches_.add_to(app); }
    CacheOptions caches_{"all"};
};

} // namespace

std::unique_ptr<AnalysisCommand> causes_command() {
    return std::make_unique<CausesCommand>();
}

} // namespace traces
