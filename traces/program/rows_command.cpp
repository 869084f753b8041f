// razor-trace rows: how a memory's rows and banks take a trace.
#include "analysis/plots/table_chart.h"
#include "analysis/traces/dram_rows.h"
#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "traces/error.h"
#include "traces/program/analyses.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace traces {
namespace {

using analysis::Table;
using analysis::Touch;

class RowsCommand final : public AnalysisCommand {
public:
    RowsCommand()
        : AnalysisCommand("rows",
                          "hits and conflicts of a memory's open rows, and how many banks are used at once",
                          "structure") {
        options_.without_lines(); // but bursts
        // What memory sees: lines of all kinds.
        options_.count_without_option({true, true, true, true, true, true, true, false});
    }
    void run() override {
        const sim::MachineDescription machine = description();
        options_.prepare({}, machine.files);
        options_.refuse_sample();
        const sim::MemoryConfig& memory = machine.config.memory;
        const auto burst = static_cast<std::uint64_t>(memory.bus_bytes * memory.burst_length);
        options_.take_lines_of(burst);
        analysis::DramRows rows(memory, static_cast<std::size_t>(reach_));
        analysis::Touches touches = options_.touches();
        options_.each_block([&](const Block& block) {
            touches.each(block, [&](const Touch& t) { rows.touch(t.line * burst, t.group); });
        });
        Table table = options_.table({"bursts", "row hits", "row empties", "row conflicts", "hit ratio",
                                      "bursts an activation", "rows", "activations a row", "banks at once"});
        for (std::size_t g = 0; g < rows.groups().size(); ++g) {
            const analysis::DramRows::Group& of = rows.groups()[g];
            if (of.bursts != 0)
                options_.add_row(table, touches, g,
                                 {of.bursts, of.hits, of.empties, of.conflicts, part(of.hits, of.bursts),
                                  part(of.bursts, of.activations()), of.rows, part(of.activations(), of.rows),
                                  part(of.banks, of.bursts)});
        }
        const std::uint64_t all = std::accumulate(rows.banks().begin(), rows.banks().end(), std::uint64_t{0});
        options_.give(
            "rows", table,
            fmt::format(
                "{} bursts of {} bytes; {} channels of {} ranks of {} x {} banks, rows of {} bytes, {}{}; "
                "banks among {} bursts; the busiest bank has {:.4f} of all, {:.2f} times its share",
                all, burst, memory.channels, memory.ranks, memory.bank_groups, memory.banks, memory.row_bytes,
                memory.mapping, memory.bank_xor == "on" ? ", bank_xor" : "", reach_, part(busiest(rows), all),
                part(busiest(rows) * rows.banks().size(), all)),
            [&] {
                return analysis::bars_of(table, options_.by_columns(),
                                         {"row hits", "row empties", "row conflicts"}, {"bursts"});
            });
    }

private:
    bool draws() const override { return true; }
    static std::uint64_t busiest(const analysis::DramRows& rows) {
        return *std::max_element(rows.banks().begin(), rows.banks().end());
    }
    sim::MachineDescription description() const {
        try {
            std::vector<std::string> settings = settings_;
            if (!preset_.empty())
                settings.insert(settings.begin(), "memory.preset=" + preset_);
            return machine_.empty() ? sim::describe_machine_text("", "the default machine", settings)
                                    : sim::describe_machine(machine_, settings);
        } catch (const sim::ConfigError& e) {
            throw Error(e.what());
        }
    }
    void add_options(CLI::App& app) override {
        app.add_option("--machine", machine_, "the memory of this machine (razor-sim)")->type_name("FILE");
        app.add_option("--preset", preset_, "the memory, as memory.preset of machines")->type_name("NAME");
        app.add_option("-g", settings_, "overrides a setting, as memory.mapping; may be given more than once")
            ->type_name("KEY=VALUE")
            ->expected(1)
            ->take_all();
        app.add_option("--reach", reach_, "bursts of which banks at once are counted; without it, 32")
            ->type_name("N")
            ->check(CLI::Range(1, 65536));
    }
    std::string machine_, preset_;
    std::vector<std::string> settings_;
    int reach_ = 32;
};

} // namespace

std::unique_ptr<AnalysisCommand> rows_command() {
    return std::make_unique<RowsCommand>();
}

} // namespace traces
