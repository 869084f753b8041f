#include "razor/program/compare_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace razor {
namespace {

using analysis::ChannelDifference;
using analysis::Comparison;
using analysis::Differences;
using json = nlohmann::ordered_json;

std::string place(std::size_t pixel, int width) {
    const auto w = static_cast<std::size_t>(width);
    return fmt::format("({}, {})", pixel % w, pixel / w);
}

/// The channel of the colour with the largest difference, or null where none differs: the units of other
/// layers are not comparable.
const ChannelDifference* worst(const Differences& differences) {
    const ChannelDifference* out = nullptr;
    for (const ChannelDifference& channel : differences.channels) {
        const bool colour =
            channel.name == "R" || channel.name == "G" || channel.name == "B" || channel.name == "Y";
        if (colour && channel.largest > (out == nullptr ? 0 : out->largest)) {
            out = &channel;
        }
    }
    return out;
}

/// One line for each channel without a partner.
std::string unmatched_text(const Differences& differences) {
    std::string out;
    for (const auto& [names, what] :
         {std::pair{&differences.only_in_a, "only in the first picture"},
          std::pair{&differences.only_in_b, "only in the second picture"},
          std::pair{&differences.stored_as_different_types, "stored as different types"}}) {
        for (const std::string& name : *names) {
            out += fmt::format("{}: {}\n", name, what);
        }
    }
    return out;
}

std::string identity_line(const Comparison& c) {
    const auto pixels = static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height);
    return c.differences.identical() ? "yes, bit for bit"
                                     : fmt::format("no; {} of {} pixels differ in some channel",
                                                   c.differences.pixels_differing, pixels);
}

std::string left_out_line(const Comparison& c) {
    const auto pixels = static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height);
    if (c.errors.pixels == pixels) {
        return "no pixel";
    }
    return fmt::format(
        "{} of {} pixels with NaN or infinity in R, G or B (picture: {} with NaN, {} infinite; "
        "reference: {}, {})",
        pixels - c.errors.pixels, pixels, c.picture.nan, c.picture.infinite, c.reference.nan,
        c.reference.infinite);
}

std::string channel_table(const Comparison& c) {
    std::string out = fmt::format("\n{:<14} {:>12} {:>12} {:>14} {:>14} {:>12}\n", "channel", "differing",
                                  "RMSE", "largest", "at", "not numbers");
    for (const ChannelDifference& channel : c.differences.channels) {
        out += fmt::format("{:<14} {:>12} {:>12.5g} {:>14.9g} {:>14} {:>12}\n", channel.name,
                           channel.differing, channel.rmse, channel.largest,
                           channel.largest == 0 ? "" : place(channel.largest_at, c.width), channel.left_out);
    }
    return out;
}

json place_json(std::size_t pixel, int width) {
    const auto w = static_cast<std::size_t>(width);
    return {{"x", pixel % w}, {"y", pixel / w}};
}

json channel_json(const ChannelDifference& channel, int width) {
    json out{{"name", channel.name},
             {"pixels_differing", channel.differing},
             {"rmse", channel.rmse},
             {"largest_difference", channel.largest},
             {"not_finite_pixels", channel.left_out},
             {"not_finite_pixels_differing", channel.not_numbers_differing}};
    out["largest_at"] = channel.largest == 0 ? json() : place_json(channel.largest_at, width);
    return out;
}

json largest_json(const Comparison& c) {
    const ChannelDifference* const channel = worst(c.differences);
    if (channel == nullptr) {
        return nullptr;
    }
    json out{{"channel", channel->name},
             {"value", channel->largest},
             {"picture", channel->a},
             {"reference", channel->b}};
    out.update(place_json(channel->largest_at, c.width));
    return out;
}

json flip_json(const Comparison& c, const analysis::FlipOptions& options) {
    json out{{"kind", c.high_dynamic_range ? "HDR" : "LDR"},
             {"pixels_per_degree", options.pixels_per_degree}};
    if (c.high_dynamic_range) {
        out["tone_mapper"] = analysis::tone_mapper_names[static_cast<std::size_t>(options.tone_mapper)];
        out["start_exposure"] = c.exposures.start;
        out["stop_exposure"] = c.exposures.stop;
        out["exposures"] = c.exposures.count;
    }
    out.update({{"mean", c.flip.mean},
                {"weighted_median", c.flip.weighted_median},
                {"weighted_first_quartile", c.flip.weighted_first_quartile},
                {"weighted_third_quartile", c.flip.weighted_third_quartile},
                {"minimum", c.flip.minimum},
                {"maximum", c.flip.maximum}});
    return out;
}

json not_finite_json(const analysis::NotFinite& count) {
    return {{"nan_pixels", count.nan}, {"infinite_pixels", count.infinite}};
}

} // namespace

std::string comparison_text(const Comparison& c, const analysis::FlipOptions& options) {
    std::string out = fmt::format("size                   {} x {}\n", c.width, c.height);
    out += fmt::format("identical              {}\n", identity_line(c));
    if (const ChannelDifference* const channel = worst(c.differences)) {
        out += fmt::format("largest difference     {:.9g} in {} at {}: {:.9g}, reference {:.9g}\n",
                           channel->largest, channel->name, place(channel->largest_at, c.width), channel->a,
                           channel->b);
    }
    out += fmt::format("left out below         {}\n", left_out_line(c));
    out += fmt::format("RMSE                   {:.6g}\n"
                       "relative MSE           {:.6g}\n"
                       "MAPE                   {:.6g}\n",
                       c.errors.rmse, c.errors.relative_mse, c.errors.mape);
    out += fmt::format(
        "{}               mean {:.6f}; weighted median {:.6f}, quartiles {:.6f} and {:.6f}; least "
        "{:.6f}, greatest {:.6f}\n",
        c.high_dynamic_range ? "HDR-FLIP" : "LDR-FLIP", c.flip.mean, c.flip.weighted_median,
        c.flip.weighted_first_quartile, c.flip.weighted_third_quartile, c.flip.minimum, c.flip.maximum);
    out += fmt::format("seen at                {:.2f} pixels a degree", options.pixels_per_degree);
    if (c.high_dynamic_range) {
        out += fmt::format(", tone mapper {}, {} exposures from {:.4f} to {:.4f} stops",
                           analysis::tone_mapper_names[static_cast<std::size_t>(options.tone_mapper)],
                           c.exposures.count, c.exposures.start, c.exposures.stop);
    }
    return out + "\n" + channel_table(c) + unmatched_text(c.differences);
}

json comparison_json(const Comparison& c, const analysis::FlipOptions& options) {
    json channels = json::array();
    for (const ChannelDifference& channel : c.differences.channels) {
        channels.push_back(channel_json(channel, c.width));
    }
    const auto pixels = static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height);
    return {{"width", c.width},
            {"height", c.height},
            {"identical", c.differences.identical()},
            {"pixels_differing", c.differences.pixels_differing},
            {"largest_difference", largest_json(c)},
            {"only_in_picture", c.differences.only_in_a},
            {"only_in_reference", c.differences.only_in_b},
            {"stored_as_different_types", c.differences.stored_as_different_types},
            {"pixels_compared", c.errors.pixels},
            {"pixels_left_out", pixels - c.errors.pixels},
            {"not_finite",
             {{"picture", not_finite_json(c.picture)}, {"reference", not_finite_json(c.reference)}}},
            {"rmse", c.errors.rmse},
            {"relative_mse", c.errors.relative_mse},
            {"mape", c.errors.mape},
            {"flip", flip_json(c, options)},
            {"channels", channels}};
}

std::string identity_text(const analysis::ImageFile& a, const analysis::ImageFile& b,
                          const Differences& differences) {
    if (!differences.same_size) {
        return fmt::format("sizes differ: {} x {} and {} x {}\n", a.width, a.height, b.width, b.height);
    }
    if (differences.identical()) {
        return fmt::format("identical: {} x {}, {} planes\n", a.width, a.height, a.channels.size());
    }
    std::string out;
    for (const ChannelDifference& channel : differences.channels) {
        if (channel.differing > 0) {
            out += fmt::format("{}: {} of {} pixels differ, first at {}; ", channel.name, channel.differing,
                               channel.pixels, place(channel.first, a.width));
            out += channel.not_numbers_differing > 0
                       ? fmt::format("{} of them NaN or infinite; ", channel.not_numbers_differing)
                       : "";
            out += fmt::format("largest difference {:.9g} at {}: {:.9g} and {:.9g}\n", channel.largest,
                               place(channel.largest_at, a.width), channel.a, channel.b);
        }
    }
    return out + unmatched_text(differences);
}

} // namespace razor
