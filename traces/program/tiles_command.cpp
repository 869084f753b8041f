// razor-trace tiles: what each screen tile of the picture asked memory for, and that over the picture.
#include "analysis/plots/svg.h"
#include "traces/error.h"
#include "traces/program/analyses.h"
#include "traces/program/cache_options.h"
#include "traces/program/tile_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

namespace traces {
namespace {

using analysis::Table;
using analysis::TileCount;
using analysis::TileFigure;
using analysis::Touch;

/// As --figure names them.
constexpr std::array<const char*, 5> figures = {"references", "bytes", "misses", "first", "ratio"};

class TilesCommand final : public AnalysisCommand {
public:
    TilesCommand()
        : AnalysisCommand("tiles", "what each screen tile asked memory for, as a table and over the picture",
                          nullptr) {
        options_.always_by_tile();
    }
    void run() override {
        const std::string drawn = figure_.empty() ? "misses" : figure_;
        const auto figure =
            static_cast<TileFigure>(std::find(figures.begin(), figures.end(), drawn) - figures.begin());
        if (drawn != figures[std::min(static_cast<std::size_t>(figure), figures.size() - 1)])
            throw Error(
                fmt::format("--figure {}: there is no such thing; give {}", drawn, fmt::join(figures, ", ")));
        const bool png = output_.ends_with(".png");
        if (over_.empty() != output_.empty())
            throw Error("--over PICTURE and -o FILE are of no use without each other; give both");
        if (!output_.empty() && !png && !output_.ends_with(".svg"))
            throw Error(fmt::format("-o {}: name a .png file, or an .svg one, which says what colours mean",
                                    output_));
        if (over_.empty() && (!range_.empty() || linear_ || !figure_.empty()))
            throw Error("--figure, --range and --linear are of what --over draws; add it, or leave them out");
        options_.prepare({output_}, {over_});
        options_.refuse_sample();
        caches_.prepare(options_.line_bytes());
        if (caches_.sizes().size() != 1)
            throw Error("--sizes: tiles are told of one size; give one");
        const Picture picture = options_.description().picture;
        std::optional<TilePicture> over;
        if (!over_.empty())
            over.emplace(over_, picture);
        analysis::TileCounts tiles(caches_.shapes()[0], picture.tiles());
        analysis::Touches touches = options_.touches();
        options_.each_block([&](const Block& block) {
            touches.each(block, [&](const Touch& t) { tiles.touch(t, caches_.cache_of(t.stream)); });
        });
        std::string text;
        std::vector<OutputFile> files;
        if (over) {
            over->draw(tiles, figure, range_, !linear_);
            files.push_back({output_, png ? over->png() : analysis::svg_file(over->svg())});
            // Counts are whole.
            text = fmt::format("; {0}: {1} from {2:.{4}f} to {3:.{4}f}", output_, drawn, over->scale().low,
                               over->scale().high, figure == analysis::TileFigure::ratio ? 4 : 0);
        }
        give(tiles, picture, text, std::move(files));
    }

private:
    /// From the upper left one on; at last what was for no tile.
    void give(const analysis::TileCounts& tiles, const Picture& picture, const std::string& text,
              std::vector<OutputFile> files) {
        Table table;
        for (const char* column : {"tile", "x", "y", "references", "bytes", "misses", "first", "ratio"})
            table.columns.emplace_back(column);
        TileCount all;
        const auto row = [&](std::string name, Table::Cell x, Table::Cell y, const TileCount& c) {
            table.rows.push_back({std::move(name), std::move(x), std::move(y), c.references, c.bytes,
                                  c.misses, c.first, part(c.misses, c.references)});
        };
        std::size_t met = 0;
        for (std::uint32_t tile = 1; tile <= picture.tiles(); ++tile) {
            const TileCount& c = tiles.counts()[tile];
            all += c;
            met += c.references != 0 ? 1 : 0;
            const std::uint64_t x = picture.left(tile), y = picture.top(tile);
            if (c.references != 0)
                row(fmt::format("{},{}", x, y), x, y, c);
        }
        const TileCount& none = tiles.counts()[0];
        row("none", "", "", none);
        options_.give(
            "tiles", table,
            fmt::format("{} touches of lines of {} bytes for {} of {} screen tiles of {} x {} pixels, "
                        "{} for none; {}{}",
                        all.references, options_.line_bytes(), met, picture.tiles(), picture.side,
                        picture.side, none.references, caches_.text(), text),
            nullptr, std::move(files));
    }
    void add_options(CLI::App& app) override {
        caches_.add_to(app);
        app.add_option("--over", over_,
                       "lay a figure of tiles over this picture, OpenEXR or PNG, of the trace's size")
            ->type_name("PICTURE");
        app.add_option("-o,--output", output_,
                       "FILE.png, the picture of --over alone, or FILE.svg, with what colours say")
            ->type_name("FILE");
        app.add_option(
               "--figure", figure_,
               fmt::format("what is drawn: {} (of misses those of lines that the cache never had), ratio "
                           "(misses of references); without it, misses",
                           "references, bytes, misses, first"))
            ->type_name("FIGURE");
        app.add_option("--range", range_, "what is coldest and hottest; without it, least and most")
            ->type_name("LOW,HIGH");
        app.add_flag("--linear", linear_, "colours by values, not by their logarithms");
    }

    std::string over_, output_, figure_, range_;
    bool linear_ = false;
    CacheOptions caches_{"1", "32KiB"};
};

} // namespace

std::unique_ptr<AnalysisCommand> tiles_command() {
    return std::make_unique<TilesCommand>();
}

} // namespace traces
