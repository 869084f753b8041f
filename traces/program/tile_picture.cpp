#include "traces/program/tile_picture.h"

#include "traces/error.h"
#include "traces/program/overlay_command.h"

#include <fmt/format.h>

namespace traces {

TilePicture::TilePicture(const std::string& file, const Picture& picture) : picture_(picture) {
    try {
        image_ = analysis::linear_rgb(analysis::read_image(file), file);
    } catch (const analysis::ImageError& e) {
        throw Error(e.what());
    }
    if (static_cast<std::uint32_t>(image_.width) != picture.width ||
        static_cast<std::uint32_t>(image_.height) != picture.height)
        throw Error(fmt::format("{}: has {} x {} pixels, and the trace is of a picture of {} x {}; give that "
                                "one, whole",
                                file, image_.width, image_.height, picture.width, picture.height));
}

void TilePicture::draw(const analysis::TileCounts& counts, analysis::TileFigure figure,
                       const std::string& range, bool logarithmic) {
    const std::vector<double> values = counts.pixels(figure, picture_);
    scale_ =
        range.empty() ? analysis::scale_of(values, logarithmic) : parse_overlay_range(range, logarithmic);
    pixels_ = analysis::overlaid(image_, values, scale_);
    name_ = fmt::format("{} of a tile", analysis::tile_figure_names[static_cast<std::size_t>(figure)]);
}

} // namespace traces
