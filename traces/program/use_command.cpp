// razor-trace use: how much of a line is used before it leaves a cache.
#include "analysis/plots/table_chart.h"
#include "analysis/traces/line_residency.h"
#include "traces/program/analyses.h"
#include "traces/program/cache_options.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Table;
using analysis::Touch;

class UseCommand final : public AnalysisCommand {
public:
    UseCommand()
        : AnalysisCommand("use", "how much of a line is used from when it comes into a cache until it goes",
                          "structure") {}
    void run() override {
        options_.prepare();
        options_.refuse_sample();
        caches_.prepare(options_.line_bytes());
        std::vector<analysis::LineResidency> all(caches_.shapes().begin(), caches_.shapes().end());
        analysis::Touches touches = options_.touches();
        options_.each_block([&](const Block& block) {
            touches.each(block, [&](const Touch& t) {
                const std::uint32_t cache = caches_.cache_of(t.stream);
                for (analysis::LineResidency& r : all)
                    r.touch(t, cache);
            });
        });
        for (analysis::LineResidency& r : all)
            r.finish();
        Table table =
            options_.table({"bytes", "fills", "touches each", "bytes used", "part used", "used once",
                            "dropped", "to a quarter", "a half", "three quarters", "more"});
        for (std::size_t g = 0; g < touches.groups(); ++g)
            for (std::size_t i = 0; i < all.size(); ++i) {
                if (g >= all[i].groups().size() || all[i].groups()[g].stays == 0)
                    continue;
                const analysis::LineResidency::Group& of = all[i].groups()[g];
                options_.add_row(table, touches, g,
                                 {caches_.sizes()[i], of.stays, part(of.touches, of.stays), of.bytes,
                                  part(of.bytes, of.stays * options_.line_bytes()), of.once, of.dropped,
                                  of.parts[0], of.parts[1], of.parts[2], of.parts[3]});
            }
        options_.give("use", table,
                      fmt::format("lines of {} bytes{}; {}", options_.line_bytes(),
                                  options_.grouped()
                                      ? fmt::format(", by {} of who brought them in", options_.by())
                                      : "",
                                  caches_.text()),
                      [&] {
                          return analysis::bars_of(table, options_.by_columns() + 1,
                                                   {"to a quarter", "a half", "three quarters", "more"},
                                                   {"lines that come"});
                      });
    }

private:
    bool draws() const override { return true; }
    void add_options(CLI::App& app) override { caches_.add_to(app); }
    CacheOptions caches_{"all"};
};

} // namespace

std::unique_ptr<AnalysisCommand> use_command() {
    return std::make_unique<UseCommand>();
}

} // namespace traces
