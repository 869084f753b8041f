// A figure of screen tiles over the picture that a trace was recorded of.
#pragma once

#include "analysis/images/linear_image.h"
#include "analysis/plots/overlay.h"
#include "analysis/traces/tile_counts.h"
#include "traces/description.h"

#include <string>

namespace traces {

class TilePicture {
public:
    /// Reads an OpenEXR or PNG file of so many pixels. Throws Error.
    TilePicture(const std::string& file, const Picture& picture);

    /// `range`: what is coldest and hottest, "LOW,HIGH"; empty: least and most. Throws Error where it is
    /// none.
    void draw(const analysis::TileCounts& counts, analysis::TileFigure figure, const std::string& range,
              bool logarithmic);
    /// What was drawn: the picture alone, or an SVG element with what colours mean.
    std::string png() const { return analysis::png_bytes(pixels_); }
    std::string svg() const { return analysis::overlay_svg(pixels_, scale_, name_); }
    const analysis::OverlayScale& scale() const { return scale_; }

private:
    Picture picture_;
    analysis::LinearImage image_;
    analysis::Pixels pixels_;
    analysis::OverlayScale scale_;
    std::string name_;
};

} // namespace traces
