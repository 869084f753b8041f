#include "razor/program/study/study_pictures.h"

#include "analysis/metrics/compare.h"
#include "analysis/metrics/hit_differences.h"
#include "analysis/study/run.h"
#include "razor/program/arguments.h"
#include "razor/program/study/scene_knobs.h"
#include "razor/scene/mesh_error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <thread>

namespace razor {
namespace {

using analysis::ImageFile;
using analysis::LinearImage;
using analysis::plain_text;
using analysis::toml_text;
using analysis::Value;

const std::vector<std::string_view> isa_names{"auto", "plain", "sse4", "avx2", "avx512"};

std::string text_or(const analysis::Settings& settings, const char* key, const std::string& preset) {
    const auto found = settings.find(key);
    return found == settings.end() ? preset : plain_text(found->second);
}

RenderOptions host_options(const analysis::Settings& settings) {
    RenderOptions out;
    out.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    if (const auto found = settings.find("threads"); found != settings.end())
        out.threads = static_cast<int>(std::get<std::int64_t>(found->second));
    out.isa = text_or(settings, "isa", "auto");
    out.share = parse_share(text_or(settings, "share", "chip"));
    const std::string memory = text_or(settings, "memory", "");
    out.memory_bytes = memory.empty() ? 0 : parse_bytes("memory", memory);
    out.eager = text_or(settings, "eager", "false") == "true";
    return out;
}

ImageFile mean_of(const std::vector<ImageFile>& images) {
    ImageFile out;
    out.width = images.front().width;
    out.height = images.front().height;
    for (const char* name : {"B", "G", "R"}) {
        analysis::Channel channel{name, analysis::Channel::Kind::float32, {}};
        for (std::size_t p = 0; p < images.front().find(name)->bits.size(); ++p) {
            double sum = 0;
            for (const ImageFile& image : images)
                sum += image.find(name)->value(p);
            channel.bits.push_back(
                std::bit_cast<std::uint32_t>(static_cast<float>(sum / static_cast<double>(images.size()))));
        }
        out.channels.push_back(std::move(channel));
    }
    return out;
}

std::vector<LinearImage> linear(const std::vector<ImageFile>& images) {
    std::vector<LinearImage> out;
    for (const ImageFile& image : images)
        out.push_back(linear_rgb(image, "a picture of a study"));
    return out;
}

/// Where all pictures hold numbers.
std::vector<bool> finite_in_all(const std::vector<const std::vector<LinearImage>*>& lists) {
    std::vector<bool> out(lists.front()->front().size(), true);
    for (const auto* list : lists)
        for (const LinearImage& image : *list)
            for (const std::vector<float>& plane : image.planes)
                for (std::size_t p = 0; p < out.size(); ++p)
                    out[p] = out[p] && std::isfinite(plane[p]);
    return out;
}

/// The root of an estimate of a square, and of the ends of its interval: three values.
std::vector<double> root_of(const analysis::Estimate& square) {
    std::vector<double> out;
    for (const double at : {square.value - square.half_width, square.value, square.value + square.half_width})
        if (std::isfinite(at))
            out.push_back(std::sqrt(std::max(at, 0.0)));
    return out;
}

} // namespace

const std::vector<std::string_view>& host_keys() {
    static const std::vector<std::string_view> keys{"threads", "isa", "share", "memory", "eager"};
    return keys;
}

std::optional<std::string> wrong_host_setting(std::string_view key, Value& value) {
    if (key == "threads")
        return wrong_whole(key, value, 1, 1024);
    if (key == "isa")
        return wrong_word(key, value, isa_names);
    if (key == "eager")
        return std::holds_alternative<bool>(value) ? "" : "eager is no flag; write true or false";
    if (key != "share" && key != "memory")
        return {};
    if (const std::string wrong = wrong_word(key, value, {}); !wrong.empty())
        return wrong;
    try {
        if (key == "share")
            parse_share(std::get<std::string>(value));
        else
            parse_bytes("memory", std::get<std::string>(value));
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

StudyPicture render_study_picture(const analysis::Settings& settings, const std::filesystem::path& folder,
                                  int seed, int frames, bool picks, const std::atomic<bool>& cancel) {
    RenderOptions options = host_options(settings);
    options.frames = frames;
    options.cancel = &cancel;
    if (picks)
        options.layers.add(LayerGroup::pick);
    SceneDescription description = describe_scene(settings, folder);
    description.settings.seed = seed;
    try {
        RenderResult result =
            naming_files(description, [&] { return render_native(build_scene(description), options); });
        return {std::move(result.film), std::move(result.statistics)};
    } catch (const Cancelled&) {
        throw analysis::Stopped{};
    }
}

ImageFile image_of(const Film& film, const std::vector<std::string>& planes) {
    ImageFile out;
    out.width = film.width;
    out.height = film.height;
    for (const std::string& name : planes) {
        const Plane* const plane = film.find(name);
        if (plane == nullptr)
            continue;
        analysis::Channel channel{name, analysis::Channel::Kind::uint32, plane->ids};
        if (plane->ids.empty()) {
            channel.kind = analysis::Channel::Kind::float32;
            for (const float value : plane->values)
                channel.bits.push_back(std::bit_cast<std::uint32_t>(value));
        }
        out.channels.push_back(std::move(channel));
    }
    std::sort(out.channels.begin(), out.channels.end(),
              [](const analysis::Channel& a, const analysis::Channel& b) { return a.name < b.name; });
    return out;
}

void add_errors(analysis::Samples& values, const std::vector<ImageFile>& pictures,
                const StudyReferences& references) {
    try {
        const ImageFile truth = mean_of(references.pictures);
        for (const ImageFile& picture : pictures) {
            const analysis::Comparison c =
                analysis::compare({picture, "the point's picture"}, {truth, "its reference"}, {});
            values["rmse"].push_back(c.errors.rmse);
            values["relative_mse"].push_back(c.errors.relative_mse);
            values["mape"].push_back(c.errors.mape);
            values["flip"].push_back(c.flip.mean);
        }
        const std::vector<LinearImage> seen = linear(pictures), right = linear(references.pictures);
        std::vector<LinearImage> pairs = linear(references.pairs);
        std::vector<const std::vector<LinearImage>*> all{&seen, &right};
        if (!pairs.empty())
            all.push_back(&pairs);
        const std::vector<bool> counted = finite_in_all(all);
        const analysis::ErrorParts parts = error_parts(seen, right, counted);
        if (pictures.size() > 1) {
            values["noise"] = root_of(parts.variance);
            values["bias"] = root_of(parts.bias_squared);
        }
        if (pairs.size() > 1) {
            for (std::size_t i = 0; i < pairs.size(); ++i)
                for (std::size_t c = 0; c < 3; ++c)
                    for (std::size_t p = 0; p < pairs[i].planes[c].size(); ++p)
                        pairs[i].planes[c][p] = seen[i].planes[c][p] - pairs[i].planes[c][p];
            values["level_bias"] = root_of(error_parts(pairs, {}, counted).bias_squared);
        }
        if (pictures.front().find("pick.Z") != nullptr &&
            references.pictures.front().find("pick.Z") != nullptr) {
            const analysis::HitDifferences hits =
                hit_differences(pictures.front(), references.pictures.front());
            values["wrong_hits"] = {hits.wrong_share()};
            values["distance_error"] = {hits.mean_distance_error};
            values["median_distance_error"] = {hits.median_distance_error};
        }
    } catch (const analysis::ImageError& error) {
        throw UserError(error.what());
    }
}

void add_times(analysis::Samples& host, const RenderStatistics& statistics) {
    host["load_seconds"].push_back(statistics.load_seconds);
    for (std::size_t i = 0; i < statistics.times.size(); ++i) {
        const std::string before = i == 0 ? "first_" : "";
        host[before + "seconds"].push_back(statistics.times[i].render_seconds);
        host[before + "processor_seconds"].push_back(statistics.times[i].render_processor_seconds);
    }
    const FrameStatistics& f = statistics.frame;
    host["built_megabytes"].push_back(1e-6 * static_cast<double>(f.grid_bytes + f.node_bytes + f.list_bytes));
    host["triangles"].push_back(static_cast<double>(f.counters.triangles_made));
}

} // namespace razor
