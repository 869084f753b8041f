// What every pixel cost on the machine, as layers of the picture: options of razor-sim run.
#pragma once

#include "razor/image/false_colour.h"
#include "sim/machine/report.h"
#include "sim/memory/owner_costs.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace sim {

class PixelCostOptions {
public:
    /// The object must outlive the parsing.
    void add_to(CLI::App& run);
    bool given() const { return costs_ || !shown_.empty(); }
    /// Throws UserError for an unknown layer or range, and where no output would have what is asked for.
    void check(const std::vector<std::string>& outputs, unsigned cache_levels) const;

    /// Adds to the film "cost.NAME" for each figure of the machine, and "build.NAME" for what of it was
    /// building. Lines are bytes there too (cost.dram_bytes). Floats: whole numbers up to 2^24 are exact,
    /// larger ones are rounded to it; of sums over pixels the report has all digits.
    static void add_layers(razor::Film& film, const OwnerCosts& costs, const Config& config);
    /// Whether PNG files show a layer.
    bool shows() const { return !shown_.empty(); }
    /// The film's layer in false colours.
    razor::Film shown(const razor::Film& film) const;
    /// What of each figure pixels caused, as a table; which layer PNG files show, and in what range.
    std::string text(const Report& report, const razor::Film& film) const;

private:
    razor::ValueRange range_in(const razor::Film& film) const;

    bool costs_ = false;
    std::string shown_, range_;
};

} // namespace sim
