// razor-trace replay: a trace through the memory systems of machines.
#pragma once

#include "analysis/traces/table.h"
#include "sim/config/machine_file.h"
#include "sim/replay/replay_report.h"
#include "traces/formats/format.h"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

namespace traces {

class ReplayCommand {
public:
    void add_to(CLI::App& app);
    bool parsed() const { return app_->parsed(); }
    void run();

private:
    enum class By { all, structure, phase, kind };
    struct Machine {
        std::string label; // as given
        sim::MachineDescription description;
    };
    std::vector<Machine> machines() const;
    std::vector<sim::ReplayResult> replay(Input& input, const std::vector<Machine>& machines) const;
    analysis::Table table(const std::vector<Machine>& machines, const std::vector<sim::ReplayResult>& results,
                          By by) const;
    void compare(const std::vector<sim::Comparison>& all) const;
    void give(const Input& input, const std::vector<Machine>& machines,
              const std::vector<sim::ReplayResult>& results) const;

    CLI::App* app_ = nullptr;
    std::string file_, from_, by_ = "all", csv_, json_, against_;
    std::vector<std::string> machines_, settings_;
    int threads_ = 0;
    bool fetches_ = false, timed_ = false;
};

} // namespace traces
