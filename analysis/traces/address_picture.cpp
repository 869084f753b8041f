#include "analysis/traces/address_picture.h"

#include "analysis/plots/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace analysis {
namespace {

using Rgb = std::array<double, 3>;

/// "#rrggbb".
Rgb rgb_of(std::string_view text) {
    Rgb out{};
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = std::stoi(std::string(text.substr(1 + 2 * i, 2)), nullptr, 16);
    return out;
}

/// White where nothing is, then from a light tint of the colour to a dark one; `part` in [0, 1].
Rgb shade(const Rgb& colour, double part) {
    Rgb out = {255, 255, 255};
    if (part > 0)
        for (std::size_t i = 0; i < 3; ++i) {
            const double light = 255 + (colour[i] - 255) * 0.3, dark = colour[i] * 0.35;
            out[i] = part < 0.6 ? light + (colour[i] - light) * part / 0.6
                                : colour[i] + (dark - colour[i]) * (part - 0.6) / 0.4;
        }
    return out;
}

/// Of the fullest, logarithmically; 0 only where nothing is.
double part_of(std::uint64_t count, std::uint64_t most) {
    if (count == 0)
        return 0;
    return most <= 1
               ? 1
               : 0.02 + 0.98 * std::log(static_cast<double>(count)) / std::log(static_cast<double>(most));
}

struct Rows {
    std::vector<const AddressTime::Row*> rows; // ascending addresses
    std::uint64_t references = 0;
};

} // namespace

AddressPicture draw(const AddressTime& counts, std::size_t width, std::size_t height) {
    const std::vector<AddressTime::Row> all = counts.rows();
    std::map<std::uint32_t, Rows> by_group;
    for (const AddressTime::Row& row : all) {
        Rows& rows = by_group[row.group];
        rows.rows.push_back(&row);
        for (const std::uint32_t n : *row.counts)
            rows.references += n;
    }
    std::vector<std::pair<std::uint32_t, const Rows*>> order;
    for (const auto& [group, rows] : by_group)
        order.emplace_back(group, &rows);
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
        return a.second->references > b.second->references;
    });

    AddressPicture out;
    const std::size_t gap = 1, least = 4;
    const std::size_t room = height > order.size() * (least + gap) ? height - order.size() * gap : 0;
    const double scale =
        std::min(1.0, static_cast<double>(room) / static_cast<double>(std::max<std::size_t>(1, all.size())));
    out.pixels.width = std::clamp<std::size_t>(counts.columns(), 1, width);
    std::size_t top = 0;
    for (const auto& [group, rows] : order) {
        const auto pixels =
            std::max(least, static_cast<std::size_t>(scale * static_cast<double>(rows->rows.size())));
        out.bands.push_back({group, top, pixels, rows->rows.front()->address, rows->rows.back()->address,
                             rows->rows.size(), 0});
        top += pixels + gap;
    }
    out.pixels.height = std::max<std::size_t>(1, top);
    std::vector<std::uint64_t> sums(out.pixels.width * out.pixels.height, 0);
    for (std::size_t b = 0; b < order.size(); ++b) {
        AddressPicture::Band& band = out.bands[b];
        const auto& rows = order[b].second->rows;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            // Several pages a line, or, where there are few, several lines a page.
            const std::size_t from = r * band.height / rows.size();
            const std::size_t to = std::max(from + 1, (r + 1) * band.height / rows.size());
            for (std::size_t line = from; line < to; ++line) {
                const std::size_t y = band.top + band.height - 1 - line;
                for (std::size_t c = 0; c < rows[r]->counts->size(); ++c) {
                    std::uint64_t& sum = sums[y * out.pixels.width + c * out.pixels.width / counts.columns()];
                    sum += (*rows[r]->counts)[c];
                    band.most = std::max(band.most, sum);
                }
            }
        }
        out.most = std::max(out.most, band.most);
    }
    out.pixels.rgb.assign(3 * sums.size(), 255);
    for (std::size_t b = 0; b < out.bands.size(); ++b) {
        const Rgb hue = rgb_of(colour(b));
        const AddressPicture::Band& band = out.bands[b];
        for (std::size_t i = band.top * out.pixels.width; i < (band.top + band.height) * out.pixels.width;
             ++i) {
            const Rgb rgb = shade(hue, part_of(sums[i], out.most));
            for (std::size_t k = 0; k < 3; ++k)
                out.pixels.rgb[3 * i + k] = static_cast<std::uint8_t>(std::lround(rgb[k]));
        }
    }
    return out;
}

std::string with_legend(const AddressPicture& picture, const AddressTime& counts,
                        const std::vector<std::string>& names, const std::string& unit) {
    constexpr double left = 10, width = 860, names_at = left + width + 8;
    const auto w = static_cast<double>(picture.pixels.width);
    const auto h = static_cast<double>(picture.pixels.height);
    // Names need some room: bands closer than a line of text move theirs down.
    const double height = std::max(h, 14.0 * static_cast<double>(picture.bands.size()));
    Svg svg(names_at + 300, height + 100);
    svg.image(left, 10, width, h, data_uri(png_bytes(picture.pixels)));
    double least = 0;
    for (std::size_t b = 0; b < picture.bands.size(); ++b) {
        const AddressPicture::Band& band = picture.bands[b];
        const double middle = 10 + static_cast<double>(band.top) + static_cast<double>(band.height) / 2;
        const double y = std::max(middle, least);
        least = y + 14;
        svg.line(left + width, middle, names_at + 4, y, colour(b));
        svg.rectangle(names_at + 4, y - 5, 9, 9, colour(b));
        svg.text(names_at + 18, y + 4,
                 fmt::format("{} ({} from 0x{:x})", names[band.group],
                             short_text(static_cast<double>(band.pages * counts.page_bytes()), Unit::bytes),
                             band.low),
                 Svg::Anchor::start, 10);
    }
    const double axis = 10 + h;
    const double length = static_cast<double>(counts.columns()) * static_cast<double>(counts.column_length());
    const auto begin = static_cast<double>(counts.begin());
    svg.line(left, axis, left + width, axis, "#333333");
    for (const double at : ticks(begin, begin + length, false, Unit::plain, 8)) {
        const double x = left + width * (at - begin) / length;
        svg.line(x, axis, x, axis + 4, "#333333");
        svg.text(x, axis + 17, short_text(at, Unit::plain), Svg::Anchor::middle, 11);
    }
    svg.text(left + width / 2, axis + 34, unit, Svg::Anchor::middle);
    // Shades, from one reference of a pixel to the most.
    constexpr std::size_t steps = 40;
    const Rgb hue = rgb_of(colour(0));
    for (std::size_t i = 0; i < steps; ++i) {
        const Rgb rgb = shade(hue, 0.02 + 0.98 * static_cast<double>(i) / (steps - 1));
        svg.rectangle(left + static_cast<double>(i) * 5, axis + 52, 5, 12,
                      fmt::format("#{:02x}{:02x}{:02x}", std::lround(rgb[0]), std::lround(rgb[1]),
                                  std::lround(rgb[2])));
    }
    svg.text(left, axis + 78, "1", Svg::Anchor::start, 11);
    svg.text(left + 5 * steps, axis + 78, short_text(static_cast<double>(picture.most), Unit::plain),
             Svg::Anchor::end, 11);
    svg.text(left + 5 * steps + 12, axis + 62,
             fmt::format("references of a pixel, logarithmic; {} of {} a column, pages of {}",
                         short_text(static_cast<double>(counts.column_length()) *
                                        std::ceil(static_cast<double>(counts.columns()) / w),
                                    Unit::plain),
                         unit, short_text(static_cast<double>(counts.page_bytes()), Unit::bytes)),
             Svg::Anchor::start, 11);
    return svg.str();
}

} // namespace analysis
