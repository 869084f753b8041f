// razor-trace strides: how far apart references are that follow each other.
#include "analysis/plots/table_chart.h"
#include "analysis/traces/strides.h"
#include "traces/program/analyses.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Access;
using analysis::Strides;
using analysis::Table;

class StridesCommand final : public AnalysisCommand {
public:
    StridesCommand()
        : AnalysisCommand(
              "strides",
              "how far apart the references are that a thread makes to the same one after the other",
              "structure") {}
    void run() override {
        options_.prepare();
        options_.refuse_sample();
        Strides strides;
        analysis::Touches touches = options_.touches();
        options_.each_block([&](const Block& block) {
            touches.each_access(block, [&](const Access& a) { strides.add(a); });
        });
        const Table table = histogram_  ? histogram(strides, touches)
                            : top_ != 0 ? frequent(strides, touches)
                                        : patterns(strides, touches);
        options_.give(
            "strides", table,
            "bytes from a reference to the next of its thread" +
                (options_.grouped() ? " and " + options_.by() : ""),
            [&] {
                const std::size_t by = options_.by_columns();
                if (histogram_)
                    return analysis::bars_of(table, by + 1, {"forwards", "backwards"}, {"references"});
                if (top_ != 0)
                    return analysis::bars_of(table, by + 1, {"at least"}, {"references"});
                return analysis::bars_of(table, by,
                                         {Strides::pattern_names.begin(), Strides::pattern_names.end()},
                                         {"references"});
            });
    }

private:
    bool draws() const override { return true; }
    void add_options(CLI::App& app) override {
        app.add_option("--top", top_, "instead, so many strides that are most frequent")
            ->type_name("N")
            ->check(CLI::Range(1, 512));
        app.add_flag("--histogram", histogram_, "instead, all strides by powers of two")->excludes("--top");
    }
    Table patterns(const Strides& strides, const analysis::Touches& touches) const {
        Table table =
            options_.table({"references", "first", "same", "sequential", "strided", "irregular",
                            "part sequential", "part strided", "part irregular", "most frequent", "part"});
        for (std::size_t g = 0; g < strides.groups().size(); ++g) {
            const Strides::Group& of = strides.groups()[g];
            const std::uint64_t all = of.references();
            std::vector<Table::Cell> row;
            row.emplace_back(all);
            for (const std::uint64_t count : of.counts)
                row.emplace_back(count);
            for (const auto pattern : {Strides::sequential, Strides::strided, Strides::irregular})
                row.emplace_back(part(of.counts[pattern], all));
            const auto most = of.values.most(1);
            row.emplace_back(most.empty() ? 0 : most[0].value);
            row.emplace_back(most.empty() ? 0 : part(most[0].count, all));
            if (all != 0)
                options_.add_row(table, touches, g, std::move(row));
        }
        return table;
    }
    Table frequent(const Strides& strides, const analysis::Touches& touches) const {
        Table table = options_.table({"stride", "at least", "at most", "part"});
        for (std::size_t g = 0; g < strides.groups().size(); ++g) {
            const Strides::Group& of = strides.groups()[g];
            for (const auto& [value, count] : of.values.most(static_cast<std::size_t>(top_)))
                options_.add_row(table, touches, g,
                                 {value, count, count + of.values.error(), part(count, of.references())});
        }
        return table;
    }
    Table histogram(const Strides& strides, const analysis::Touches& touches) const {
        Table table = options_.table({"from", "to", "forwards", "backwards"});
        for (std::size_t g = 0; g < strides.groups().size(); ++g) {
            const Strides::Group& of = strides.groups()[g];
            for (std::size_t b = 0; b < Strides::buckets; ++b)
                if (of.forwards[b] + of.backwards[b] != 0) {
                    std::vector<Table::Cell> row; // g++ 12 warns of lists of cells here
                    for (const std::uint64_t n :
                         {b == 0 ? 0 : std::uint64_t{1} << (b - 1),
                          b == 0 ? 0 : ~std::uint64_t{0} >> (64 - b), of.forwards[b], of.backwards[b]})
                        row.emplace_back(n);
                    options_.add_row(table, touches, g, std::move(row));
                }
        }
        return table;
    }

    int top_ = 0;
    bool histogram_ = false;
};

} // namespace

std::unique_ptr<AnalysisCommand> strides_command() {
    return std::make_unique<StridesCommand>();
}

} // namespace traces
