#include "sim/program/compare_command.h"

#include "razor/image/output_file.h"
#include "razor/program/arguments.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "sim/reports/compare.h"

#include <fmt/format.h>

namespace sim {

void CompareCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand(
        "compare", "compare two designs by the JSON reports of their runs: settings, figures, traffic");
    command_->add_option("reports", first_,
                         "two reports of razor-sim run --json; with --with, one or more of the first design, "
                         "which differ in --jitter alone");
    command_->get_option("reports")->type_name("A.json B.json")->required();
    command_->add_option("--with", second_, "reports of the second design")->type_name("B.json ...");
    command_->add_option("--noise", noise_, "differences of less than so many percent mean nothing")
        ->type_name("PERCENT");
    command_->add_flag("--all", all_, "also every other figure that differs beyond noise");
    command_->add_option("--json", json_, "write all of it for programs")->type_name("FILE");
}

int CompareCommand::run() const {
    std::vector<std::string> first = first_, second = second_;
    if (second.empty()) {
        if (first.size() != 2)
            throw razor::UserError(fmt::format("compare: {} report{} given; give two, or those of the second "
                                               "design behind --with",
                                               first.size(), first.size() == 1 ? "" : "s"));
        second = {first.back()};
        first.pop_back();
    }
    const double noise = razor::parse_number("--noise", noise_, {0, 100});
    const auto read = [](const std::vector<std::string>& files) {
        std::vector<ReportFile> reports;
        for (const std::string& file : files) {
            reports.push_back(read_report(file));
            razor::note_input(file);
        }
        return reports;
    };
    const ReportComparison comparison = compare_reports(read(first), read(second));
    if (!json_.empty())
        razor::write_text_file(json_, comparison_json(comparison));
    fmt::print("{}", comparison_text(comparison, noise, all_));
    return 0;
}

} // namespace sim
