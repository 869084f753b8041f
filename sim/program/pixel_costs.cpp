#include "sim/program/pixel_costs.h"

#include "razor/image/output.h"
#include "razor/program/arguments.h"
#include "razor/scene/error.h"
#include "razor/scene/nearest.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {
namespace {

constexpr std::array<const char*, 2> groups = {"cost", "build"}; // all; building alone

std::vector<std::string> layer_names(unsigned cache_levels) {
    std::vector<std::string> names;
    for (const char* group : groups) {
        for (const OwnerFigure& f : owner_figures(cache_levels))
            names.push_back(fmt::format("{}.{}", group, f.name));
        names.push_back(fmt::format("{}.dram_bytes", group));
    }
    return names;
}

bool never(float) {
    return false;
}

} // namespace

void PixelCostOptions::add_to(CLI::App& run) {
    run.add_flag(
        "--costs", costs_,
        "add to EXR files what every pixel cost on the machine: cost.cycles (of threads), .stalled, "
        ".waiting, .instructions, .l1_misses, .l2_misses, .dram_reads, .dram_writes, .dram_bytes, and "
        "build.cycles, ... for what of it went into building what rays met first; lanes of a packet "
        "share evenly what it cost; what no pixel caused is told. Changes no other figure");
    run.add_option("--false-colour", shown_,
                   "PNG files show a layer of --costs, such as cost.cycles, in colours, dark to bright")
        ->type_name("LAYER");
    run.add_option("--range", range_,
                   "of --false-colour, what is darkest and brightest; without it, least and most")
        ->type_name("LOW:HIGH");
}

void PixelCostOptions::check(const std::vector<std::string>& outputs, unsigned cache_levels) const {
    const auto is_picture = [](const std::string& output) { return razor::is_png(output); };
    if (!range_.empty() && shown_.empty())
        throw razor::UserError("--range without --false-colour; leave it out");
    if (costs_ && shown_.empty() && std::all_of(outputs.begin(), outputs.end(), is_picture))
        throw razor::UserError("--costs go into EXR files; add -o FILE.exr, or show one by --false-colour");
    if (shown_.empty())
        return;
    if (std::none_of(outputs.begin(), outputs.end(), is_picture))
        throw razor::UserError("--false-colour is of PNG files; add -o FILE.png");
    const std::vector<std::string> names = layer_names(cache_levels);
    const std::vector<std::string_view> known(names.begin(), names.end());
    if (std::find(names.begin(), names.end(), shown_) == names.end())
        throw razor::UserError(fmt::format("--false-colour '{}' is no layer of --costs; {}",
                                           razor::printable(shown_),
                                           razor::or_known(shown_, known, "There are")));
    if (!range_.empty())
        razor::parse_bounds("--range", range_);
}

void PixelCostOptions::add_layers(razor::Film& film, const OwnerCosts& costs, const Config& config) {
    const auto line = static_cast<std::uint64_t>(config.last_cache().line_bytes);
    // Pixels have the numbers of the whole picture; some beside the film are of its screen tiles.
    const razor::PictureWindow whole =
        film.window.value_or(razor::PictureWindow{0, 0, film.width, film.height});
    std::vector<std::uint64_t> sums(film.pixel_count());
    for (const char* group : groups) {
        std::vector<std::uint64_t> bytes(film.pixel_count());
        const auto add = [&](std::string_view name, const std::vector<std::uint64_t>& of) {
            std::vector<float>& values = film.add(fmt::format("{}.{}", group, name)).values;
            std::transform(of.begin(), of.end(), values.begin(),
                           [](std::uint64_t n) { return static_cast<float>(n); });
        };
        for (const OwnerFigure& figure : owner_figures(config.cache_levels())) {
            std::fill(sums.begin(), sums.end(), 0);
            costs.share(figure, group == groups[1], [&](std::int32_t pixel, std::uint64_t amount) {
                const int x = pixel % whole.width - whole.x, y = pixel / whole.width - whole.y;
                if (x >= 0 && x < film.width && y >= 0 && y < film.height)
                    sums[static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width) +
                         static_cast<std::size_t>(x)] += amount;
            });
            add(figure.name, sums);
            if (figure.of_traffic == &Traffic::memory_reads || figure.of_traffic == &Traffic::memory_writes)
                for (std::size_t i = 0; i < sums.size(); ++i)
                    bytes[i] += line * sums[i];
        }
        add("dram_bytes", bytes);
    }
}

razor::ValueRange PixelCostOptions::range_in(const razor::Film& film) const {
    if (range_.empty())
        return razor::range_of(*film.find(shown_), never);
    const auto [low, high] = razor::parse_bounds("--range", range_);
    return {low, high};
}

razor::Film PixelCostOptions::shown(const razor::Film& film) const {
    return razor::false_coloured(film, *film.find(shown_), false, range_in(film), never);
}

std::string PixelCostOptions::text(const Report& report, const razor::Film& film) const {
    std::string out = fmt::format("\n{:<16} {:>14} {:>14} {:>14}   (costs by pixel)\n", "figure", "pixels",
                                  "of it builds", "no pixel's");
    for (const OwnerSum& sum : report.owners)
        out += fmt::format("{:<16} {:>14} {:>14} {:>14}\n", sum.name, sum.owners, sum.builds, sum.nobody);
    if (shows()) {
        const razor::ValueRange range = range_in(film);
        out += fmt::format("{}: {:.6g} (dark) to {:.6g} (bright)\n", shown_, range.low, range.high);
    }
    return out;
}

} // namespace sim
