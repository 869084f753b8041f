// razor-sim dram: a memory by itself under streams of requests.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace sim {

class DramTable {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    /// Returns the exit code. Throws razor::UserError and ConfigError.
    int run() const;

private:
    std::string machine_, preset_, json_, controller_ = "both", requests_ = "100000", in_flight_ = "64",
                                          bytes_ = "1024", stride_, seed_ = "1";
    std::vector<std::string> settings_, streams_, loads_;
};

} // namespace sim
