// razor-trace reuse: how many others are touched between two touches of a line.
#include "analysis/traces/lru_curve.h"
#include "traces/program/analyses.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Table;
using analysis::Touch;

class ReuseCommand final : public AnalysisCommand {
public:
    ReuseCommand()
        : AnalysisCommand("reuse", "how many other lines are touched between two touches of one", "all") {}
    void run() override {
        options_.prepare();
        options_.refuse_sample();
        std::vector<std::uint64_t> powers;
        for (unsigned shift = 0; shift < 40; ++shift)
            powers.push_back(std::uint64_t{1} << shift);
        analysis::LruCurve lru(powers);
        analysis::Touches touches = options_.touches();
        options_.each_block([&](const Block& block) {
            touches.each(block, [&](const Touch& t) { lru.touch(t.line, t.group); });
        });
        Table table = options_.table({"others from", "to", "references", "part"});
        std::size_t shown = 0;
        while (shown < powers.size() && (shown == 0 || powers[shown - 1] < lru.lines()))
            ++shown;
        std::uint64_t references = 0;
        for (std::size_t g = 0; g < touches.groups(); ++g) {
            const std::uint64_t all = lru.counts().references(g);
            references += all;
            const auto row = [&](Table::Cell from, Table::Cell to, std::uint64_t count) {
                options_.add_row(table, touches, g,
                                 {std::move(from), std::move(to), count, part(count, all)});
            };
            for (std::size_t i = 0; i < shown; ++i) // a distance counts the line itself
                row(i == 0 ? 0 : powers[i - 1], powers[i] - 1, lru.counts().at(g, i));
            row(std::string("first touch"), std::string(), lru.counts().firsts(g));
        }
        options_.give("reuse", table,
                      fmt::format("{} touches of {} lines of {} bytes", references, lru.lines(),
                                  options_.line_bytes()));
    }
};

} // namespace

std::unique_ptr<AnalysisCommand> reuse_command() {
    return std::make_unique<ReuseCommand>();
}

} // namespace traces
