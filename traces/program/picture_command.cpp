// razor-trace picture: which addresses are referenced when, as a picture.
#include "analysis/plots/svg.h"
#include "analysis/traces/address_picture.h"
#include "traces/error.h"
#include "traces/program/analyses.h"

#include <fmt/format.h>

namespace traces {
namespace {

using analysis::Access;
using analysis::Table;

class PictureCommand final : public AnalysisCommand {
public:
    PictureCommand()
        : AnalysisCommand("picture", "draw addresses over time, a band for each data structure",
                          "structure") {
        options_.without_lines();
    }
    void run() override {
        const std::size_t dot = file_.rfind('.');
        const std::string suffix = dot == std::string::npos ? "" : file_.substr(dot);
        if (suffix != ".png" && suffix != ".svg")
            throw Error(
                fmt::format("-o {}: name a .png file, or an .svg one, which says what is what", file_));
        options_.prepare({file_});
        analysis::AddressTime counts;
        analysis::Touches touches = options_.touches();
        options_.each_block(
            [&](const Block& block) { touches.each_access(block, [&](const Access& a) { counts.add(a); }); });
        if (counts.columns() == 0)
            throw Error(fmt::format("{}: holds no references; record some, or give its format by --from",
                                    options_.file()));
        const analysis::AddressPicture picture =
            analysis::draw(counts, static_cast<std::size_t>(width_), static_cast<std::size_t>(height_));
        std::vector<std::string> names;
        for (std::size_t g = 0; g < touches.groups(); ++g)
            names.push_back(touches.name(g, options_.description()));
        // What the picture shows, from its top.
        Table table = options_.table(
            {"line of pixels", "lines", "first page", "last page", "pages", "references of a pixel at most"});
        for (const auto& band : picture.bands)
            options_.add_row(table, touches, band.group,
                             {std::uint64_t{band.top}, std::uint64_t{band.height},
                              fmt::format("0x{:x}", band.low), fmt::format("0x{:x}", band.high), band.pages,
                              band.most});
        options_.give(
            "picture", table,
            fmt::format("{} x {} pixels; {} columns of {} of the trace's time ({}) from {}, pages of "
                        "{} bytes{}",
                        picture.pixels.width, picture.pixels.height, counts.columns(), counts.column_length(),
                        options_.description().time, counts.begin(), counts.page_bytes(),
                        options_.of_sample()),
            nullptr,
            {{file_, suffix == ".png" ? analysis::png_bytes(picture.pixels)
                                      : analysis::svg_file(analysis::with_legend(
                                            picture, counts, names, options_.description().time))}});
    }

private:
    void add_options(CLI::App& app) override {
        app.add_option("-o,--output", file_, "FILE.png, the picture alone, or FILE.svg, with axes and names")
            ->required();
        app.add_option("--width", width_, "pixels at most; without it, 1024")->check(CLI::Range(16, 2048));
        app.add_option("--height", height_, "pixels at most, of many bands more; without it, 768")
            ->check(CLI::Range(16, 4096));
    }
    std::string file_;
    int width_ = 1024, height_ = 768;
};

} // namespace

std::unique_ptr<AnalysisCommand> picture_command() {
    return std::make_unique<PictureCommand>();
}

} // namespace traces
