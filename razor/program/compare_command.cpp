#include "razor/program/compare_command.h"

#include "analysis/metrics/colour_map.h"
#include "analysis/metrics/compare.h"
#include "razor/image/output.h"
#include "razor/image/output_file.h"
#include "razor/program/arguments.h"
#include "razor/program/compare_report.h"
#include "razor/program/interrupt.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <filesystem>

namespace razor {
namespace {

using analysis::ImageFile;

// Below, kernels underflow; above, they are wider than pictures.
constexpr Range pixels_per_degree_range{1, 1000};
constexpr Range exposure_range{-100, 100};
constexpr Range exposures_range{1, 1000};

ImageFile read(const std::string& path) {
    try {
        return analysis::read_image(path);
    } catch (const analysis::ImageError& error) {
        throw UserError(printable(error.what(), 1000));
    }
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    return std::filesystem::equivalent(a, b, error);
}

Film flip_map(const analysis::Comparison& comparison) {
    Film film(comparison.width, comparison.height);
    for (const char* name : {"R", "G", "B"}) {
        film.add(name);
    }
    for (std::size_t i = 0; i < comparison.flip_map.size(); ++i) {
        const float error = comparison.flip_map[i];
        const analysis::Colour colour =
            std::isnan(error) ? analysis::no_error_colour : analysis::error_colour(error);
        for (std::size_t c = 0; c < 3; ++c) {
            film.planes[c].values[i] = colour[c];
        }
    }
    return film;
}

/// Picture minus reference: of every channel in both for radiance, of linear R, G, B for values of a display.
/// Equal infinities give 0. The plane FLIP holds the error map.
Film signed_difference(const ImageFile& picture, const ImageFile& reference,
                       const analysis::Comparison& comparison) {
    Film film(comparison.width, comparison.height);
    const auto add = [&](const std::string& name, const auto& a, const auto& b) {
        std::vector<float>& out = film.add(name).values;
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double value_a = a(i), value_b = b(i);
            out[i] = value_a == value_b ? 0.0F : static_cast<float>(value_a - value_b);
        }
    };
    if (comparison.high_dynamic_range) {
        for (const analysis::ChannelDifference& channel : comparison.differences.channels) {
            const analysis::Channel& a = *picture.find(channel.name);
            const analysis::Channel& b = *reference.find(channel.name);
            add(
                channel.name, [&](std::size_t i) { return a.value(i); },
                [&](std::size_t i) { return b.value(i); });
        }
    } else {
        const analysis::LinearImage a = analysis::linear_rgb(picture, ""),
                                    b = analysis::linear_rgb(reference, "");
        constexpr std::array<const char*, 3> names{"R", "G", "B"};
        for (std::size_t c = 0; c < 3; ++c) {
            add(
                names[c], [&](std::size_t i) { return double{a.planes[c][i]}; },
                [&](std::size_t i) { return double{b.planes[c][i]}; });
        }
    }
    film.add("FLIP").values = comparison.flip_map;
    return film;
}

} // namespace

void CompareCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand("compare", "measure how far a picture is from a reference");
    CLI::App& compare = *command_;
    compare.add_option("picture", picture_, "the picture, OpenEXR or PNG")->type_name("A")->required();
    compare.add_option("reference", reference_, "the reference, which errors are relative to")
        ->type_name("B")
        ->required();
    CLI::Option* const output =
        compare
            .add_option(
                "-o,--output", outputs_,
                "the difference: .png is the FLIP error map (black none, white most, green no number), "
                ".exr A - B; may be given more than once")
            ->type_name("FILE")
            ->expected(1)
            ->take_all();
    CLI::Option* const json =
        compare.add_option("--json", json_, "write all figures for programs")->type_name("FILE.json");
    compare
        .add_option(
            "--pixels-per-degree", pixels_per_degree_,
            "what one degree of the field of view covers; without it 67.02, a 0.7 m wide display of 3840 "
            "pixels seen from 0.7 m")
        ->type_name("X");
    compare.add_option("--tone-mapper", tone_mapper_, "of HDR-FLIP: aces (the default), hable or reinhard")
        ->type_name("NAME");
    compare
        .add_option("--start-exposure", start_exposure_,
                    "of HDR-FLIP, in stops; without it, where the brightest pixel of B reaches 0.85")
        ->type_name("X");
    compare
        .add_option("--stop-exposure", stop_exposure_,
                    "of HDR-FLIP, in stops; without it, where the median of B reaches 0.85")
        ->type_name("X");
    compare.add_option("--exposures", exposures_, "how many, from start to stop; without it, one a stop")
        ->type_name("N");
    compare
        .add_flag("--identical", identical_,
                  "only compare all channels bit by bit; exit code 1 where anything differs")
        ->excludes(output)
        ->excludes(json);
    compare.footer(
        "RMSE, relative MSE (A - B)^2 / (B + 0.01)^2, MAPE |A - B| / (B + 0.01), means over pixels and R, "
        "G, B in linear light; HDR-FLIP of OpenEXR pictures, LDR-FLIP of PNG pictures. Pixels with NaN "
        "or infinity are counted and left out.");
}

int CompareCommand::run_identical() const {
    const ImageFile a = read(picture_), b = read(reference_);
    const analysis::Differences differences = analysis::differences(a, b);
    fmt::print("{}", identity_text(a, b, differences));
    return differences.identical() ? 0 : 1;
}

int CompareCommand::run() const {
    if (identical_) {
        return run_identical();
    }
    analysis::FlipOptions options;
    if (!pixels_per_degree_.empty()) {
        options.pixels_per_degree =
            parse_number("--pixels-per-degree", pixels_per_degree_, pixels_per_degree_range);
    }
    if (!tone_mapper_.empty()) {
        options.tone_mapper = static_cast<analysis::ToneMapper>(
            parse_choice("--tone-mapper", tone_mapper_, analysis::tone_mapper_names));
    }
    if (!start_exposure_.empty()) {
        options.start_exposure = parse_number("--start-exposure", start_exposure_, exposure_range);
    }
    if (!stop_exposure_.empty()) {
        options.stop_exposure = parse_number("--stop-exposure", stop_exposure_, exposure_range);
    }
    if (!exposures_.empty()) {
        options.exposures = parse_whole("--exposures", exposures_, exposures_range);
    }
    for (const std::string& output : outputs_) {
        check_output(output);
    }
    if (!json_.empty()) {
        check_writable(json_);
    }
    std::vector<std::filesystem::path> written(outputs_.begin(), outputs_.end());
    written.emplace_back(json_);
    check_apart(written);
    for (const std::filesystem::path& output : written) {
        if (same_file(output, picture_) || same_file(output, reference_)) {
            throw UserError(fmt::format("{}: is one of the pictures compared; name another output",
                                        printable(output.string(), 1000)));
        }
    }

    const ImageFile picture = read(picture_), reference = read(reference_);
    if (analysis::is_display_referred(reference) &&
        !(tone_mapper_.empty() && start_exposure_.empty() && stop_exposure_.empty() && exposures_.empty())) {
        throw UserError("tone mapper and exposures are for OpenEXR pictures; leave these options out");
    }
    analysis::Comparison comparison;
    try {
        comparison = analysis::compare({picture, picture_}, {reference, reference_}, options);
    } catch (const analysis::ImageError& error) {
        throw UserError(printable(error.what(), 2000));
    }

    const OutputGuard guard;
    for (const std::string& output : outputs_) {
        const bool png = is_png(output);
        write_image(output, png ? flip_map(comparison) : signed_difference(picture, reference, comparison),
                    {{"razor.version", std::string(version())}});
    }
    if (!json_.empty()) {
        nlohmann::ordered_json report{
            {"program", "razor"}, {"version", version()}, {"picture", picture_}, {"reference", reference_}};
        report.update(comparison_json(comparison, options));
        // File names need not be UTF-8.
        write_json_file(json_, report);
    }
    fmt::print("{}", comparison_text(comparison, options));
    return 0;
}

} // namespace razor
