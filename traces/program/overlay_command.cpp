#include "traces/program/overlay_command.h"

#include "analysis/images/linear_image.h"
#include "analysis/plots/overlay.h"
#include "analysis/plots/svg.h"
#include "traces/error.h"
#include "traces/io/sink.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace traces {

analysis::OverlayScale parse_overlay_range(const std::string& text, bool logarithmic) {
    analysis::OverlayScale out{0, 0, logarithmic};
    const char* const end = text.data() + text.size();
    const auto low = std::from_chars(text.data(), end, out.low);
    const bool comma = low.ec == std::errc() && low.ptr != end && *low.ptr == ',';
    const auto high = comma ? std::from_chars(low.ptr + 1, end, out.high) : low;
    if (!comma || high.ec != std::errc() || high.ptr != end || !(out.low < out.high) ||
        !std::isfinite(out.high) || !std::isfinite(out.low) || (logarithmic && !(out.low > 0)))
        throw Error(fmt::format("--range '{}': give LOW,HIGH, two numbers, the lower one first{}", text,
                                logarithmic ? " and above 0, or --linear" : ""));
    return out;
}

void OverlayCommand::add_to(CLI::App& app) {
    app_ = app.add_subcommand("overlay", "draw what each pixel's rays touched over the picture");
    app_->add_option("PICTURE", picture_, "an OpenEXR file of `razor render --layers bytes`")->required();
    app_->add_option("-o,--output", output_,
                     "FILE.png, the picture alone, or FILE.svg, with what colours say")
        ->required();
    app_->add_option("--layer", layer_,
                     "what is drawn, as bytes.touched (the default), bytes.grids, steps.nodes")
        ->type_name("NAME");
    app_->add_option("--range", range_, "what is coldest and hottest; without it, least and most")
        ->type_name("LOW,HIGH");
    app_->add_flag("--linear", linear_, "colours by values, not by their logarithms");
}

void OverlayCommand::run() const {
    const bool png = output_.ends_with(".png");
    if (!png && !output_.ends_with(".svg"))
        throw Error(
            fmt::format("-o {}: name a .png file, or an .svg one, which says what colours mean", output_));
    check_apart({output_}, {picture_});
    analysis::ImageFile file;
    analysis::LinearImage picture;
    try {
        file = analysis::read_image(picture_);
        picture = analysis::linear_rgb(file, picture_);
    } catch (const analysis::ImageError& e) {
        throw Error(e.what());
    }
    const analysis::Channel* const layer = file.find(layer_);
    if (layer == nullptr) {
        std::string names;
        for (const analysis::Channel& c : file.channels)
            names += (names.empty() ? "" : ", ") + c.name;
        throw Error(fmt::format("{}: has no layer {}; render it with one (--layers), or give one of {}",
                                picture_, layer_, names));
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < picture.size(); ++i)
        values.push_back(layer->value(i));
    const analysis::OverlayScale scale =
        range_.empty() ? analysis::scale_of(values, !linear_) : parse_overlay_range(range_, !linear_);
    const analysis::Pixels pixels = analysis::overlaid(picture, values, scale);
    write_files({{output_, png ? analysis::png_bytes(pixels)
                               : analysis::svg_file(analysis::overlay_svg(pixels, scale, layer_))}});
}

} // namespace traces
