#include "razor/program/study/image_study.h"

#include "razor/image/exr.h"
#include "razor/native/targets.h"
#include "razor/program/arguments.h"
#include "razor/program/study/rival.h"
#include "razor/program/study/scene_knobs.h"
#include "razor/program/study/study_pictures.h"
#include "razor/scene/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sys/resource.h>

namespace razor {
namespace {

using analysis::plain_text;
using analysis::Point;
using analysis::Result;
using analysis::toml_text;
using analysis::Value;

/// What levels of detail and with them shapes depend on.
constexpr std::array<std::string_view, 3> level_keys{"lod", "edge_pixels", "shading"};
/// Apart from those of points, so that their samples are independent.
constexpr int first_reference_seed = 1'000'003;
const std::vector<std::string> planes{"R", "G", "B", "pick.Z", "pick.instance"};

std::string wrong_image_setting(std::string_view key, Value& value) {
    if (auto wrong = wrong_scene_setting(key, value))
        return *wrong;
    if (auto wrong = wrong_host_setting(key, value))
        return *wrong;
    return no_scene_setting(key, host_keys());
}

analysis::Settings without_host(analysis::Settings settings) {
    for (const std::string_view key : host_keys())
        settings.erase(std::string(key));
    return settings;
}

/// What a rival adds of its own is none of a scene's.
analysis::Settings known_only(const analysis::Settings& settings) {
    analysis::Settings out;
    for (const auto& [key, value] : settings) {
        Value copy = value;
        if (wrong_image_setting(key, copy).empty())
            out.emplace(key, copy);
    }
    return out;
}

std::filesystem::path reference_file(const analysis::Store& store, const Point& reference) {
    return store.folder() / "references" / (reference.name + ".exr");
}

std::vector<analysis::ImageFile> read_references(const std::vector<Point>& references,
                                                 const analysis::Store& store) {
    std::vector<analysis::ImageFile> out;
    for (const Point& reference : references) {
        const auto result = store.read_result(reference);
        if (result && !result->failed.empty())
            throw UserError(fmt::format("its reference {} failed: {}", reference.name, result->failed));
        try {
            out.push_back(analysis::read_image(reference_file(store, reference)));
        } catch (const analysis::ImageError& error) {
            throw UserError(fmt::format("{}; remove results/{}.json too, and it is made again", error.what(),
                                        reference.name));
        }
    }
    return out;
}

/// A rival whose command names no seed draws the same picture again and again: one says nothing of noise.
bool takes_no_seed(const analysis::Study& study, const Point& point) {
    const analysis::Rival* const rival = analysis::find_rival(study, point.rival);
    return rival != nullptr &&
           std::none_of(rival->command.begin(), rival->command.end(),
                        [](const std::string& word) { return word.find("{seed}") != std::string::npos; });
}

double process_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

} // namespace

StudyProgram image_study_program() {
    StudyProgram out;
    out.name = fmt::format("razor {}", version());
    out.figures = {{"seconds", "a frame after the first, s"},
                   {"processor_seconds", "a frame after the first, processor seconds"},
                   {"first_seconds", "the first frame, pages of topology included, s"},
                   {"first_processor_seconds", "the first frame, processor seconds"},
                   {"load_seconds", "analysis of the scene before the first frame, s"},
                   {"rmse", "RMSE"},
                   {"relative_mse", "relative MSE"},
                   {"mape", "MAPE"},
                   {"flip", "mean HDR-FLIP"},
                   {"noise", "noise (standard deviation)"},
                   {"bias", "bias (of the mean of many seeds)"},
                   {"level_bias", "bias by levels of detail"},
                   {"wrong_hits", "pixels whose middle sees another instance, part of all"},
                   {"distance_error", "error of hit distances, mean, relative"},
                   {"median_distance_error", "error of hit distances, median, relative"},
                   {"samples_taken", "samples a pixel"},
                   {"triangles", "triangles made"},
                   {"built_megabytes", "what the frame built, MB"},
                   {"process_megabytes", "the process at most, MiB"}};
    out.vocabulary.kind = "image";
    out.vocabulary.files = {"scene"};
    out.vocabulary.wrong = wrong_image_setting;
    out.name_figures();
    out.views.plots = {{"seconds", "rmse", {}}, {"seconds", "flip", {}}};
    out.remarks = {
        "Errors are of each seed's picture beside the mean of the references (RMSE, relative MSE and MAPE as "
        "pbrt's imgtool defines them, HDR-FLIP by Andersson et al. 2021). Bias and noise are estimated from "
        "all seeds without each other's part: the median is the estimate, the least and the greatest are the "
        "ends of its 95 % interval. Bias by levels of detail is measured beside pictures of the same seeds "
        "and "
        "samples at the reference's levels, so that noise which both have in common is none.",
        "Hits are of one ray through each pixel's middle, beside those at the reference's levels of detail, "
        "which "
        "stand for the limit surface: where edges are k times as long, they are about k^2 times as far from "
        "it."};
    return out;
}

ImageStudy::ImageStudy(const analysis::Study& study, std::filesystem::path folder,
                       const std::atomic<bool>& cancel)
    : study_(study), folder_(std::move(folder)), cancel_(cancel) {}

const ImageStudy::Described& ImageStudy::described(const analysis::Settings& settings) const {
    const std::string text = toml_text(settings);
    if (const auto found = described_.find(text); found != described_.end())
        return found->second;
    const SceneDescription scene = describe_scene(settings, folder_);
    return described_
        .emplace(text, Described{scene_digest(settings, folder_, scene), with_defaults(settings, scene)})
        .first->second;
}

analysis::Settings ImageStudy::reference_settings(const Point& point) const {
    return analysis::overlaid(without_host(known_only(point.settings)), without_host(study_.reference));
}

bool ImageStudy::is_paired() const {
    return std::any_of(level_keys.begin(), level_keys.end(),
                       [this](std::string_view key) { return study_.reference.contains(std::string(key)); });
}

analysis::Settings ImageStudy::paired_settings(const Point& point) const {
    analysis::Settings out = without_host(known_only(point.settings));
    for (const std::string_view key : level_keys)
        if (const auto found = study_.reference.find(std::string(key)); found != study_.reference.end())
            out.insert_or_assign(found->first, found->second);
    return out;
}

std::string ImageStudy::body(const Point& point) const {
    const Described& scene = described(known_only(point.settings));
    std::string out = fmt::format("# A point of razor study.\nkind = \"image\"\nprogram = {}\nlanes = "
                                  "{}\nscene_digest = {}\nseeds = {}\n",
                                  toml_text(Value(image_study_program().name)), ISA_WIDTH,
                                  toml_text(Value(scene.digest)), study_.seeds);
    out += fmt::format("repeats = {}\n", study_.repeats);
    std::string names;
    for (const Point& reference : references_of(point))
        names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", reference.name);
    out += fmt::format("references = [{}]\n", names);
    if (!point.rival.empty()) {
        const analysis::Rival& rival = *analysis::find_rival(study_, point.rival);
        out += fmt::format("\n[rival]\nname = {}\n", toml_text(Value(rival.name)));
        for (std::size_t i = 0; i < rival.command.size(); ++i)
            out += fmt::format("command_{} = {}\n", i, toml_text(Value(rival.command[i])));
        for (const auto& [figure, pointer] : rival.figures)
            out += fmt::format("figure_{} = {}\n", figure, toml_text(Value(pointer)));
    }
    out += fmt::format("\n[settings]\n{}", toml_text(analysis::overlaid(scene.settings, point.settings)));
    if (!point.rival.empty())
        return out;
    // What is paired does not change the point's own picture, but what is said of it.
    std::string pairs;
    for (const Point& pair : pairs_of(point))
        pairs += fmt::format("{}\"{}\"", pairs.empty() ? "" : ", ", pair.name);
    return out + fmt::format("\n[compared]\npairs = [{}]\n", pairs);
}

Point ImageStudy::picture(analysis::Settings settings, int seed) const {
    const Described& scene = described(settings);
    Point out;
    out.settings = std::move(settings);
    out.settings.insert_or_assign("seed", std::int64_t{seed});
    out.body = fmt::format("# A picture that points of razor study are compared with.\nkind = \"image "
                           "reference\"\nprogram = {}\n"
                           "scene_digest = {}\n\n[settings]\n{}",
                           toml_text(Value(image_study_program().name)), toml_text(Value(scene.digest)),
                           toml_text(analysis::overlaid(scene.settings, out.settings)));
    out.name = analysis::point_name(out.body);
    return out;
}

std::vector<Point> ImageStudy::references_of(const Point& point) const {
    std::vector<Point> out;
    for (int i = 0; i < study_.reference_seeds; ++i)
        out.push_back(picture(reference_settings(point), first_reference_seed + i));
    return out;
}

std::vector<Point> ImageStudy::pairs_of(const Point& point) const {
    std::vector<Point> out;
    if (is_paired() && point.rival.empty())
        for (int seed = 1; seed <= study_.seeds; ++seed)
            out.push_back(picture(paired_settings(point), seed));
    return out;
}

std::vector<Point> ImageStudy::references(const std::vector<Point>& points) const {
    std::vector<Point> out;
    std::set<std::string> known;
    for (const Point& point : points)
        for (const std::vector<Point>& some : {references_of(point), pairs_of(point)})
            for (const Point& one : some)
                if (known.insert(one.name).second)
                    out.push_back(one);
    return out;
}

std::string ImageStudy::changed(const Point& point) const {
    return changed_scene(known_only(point.settings), folder_, analysis::stated(point.body, "scene_digest"));
}

Result ImageStudy::make_reference(const Point& reference, const analysis::Store& store) const {
    std::filesystem::create_directories(store.folder() / "references");
    analysis::Settings settings = reference.settings;
    const auto seed = static_cast<int>(std::get<std::int64_t>(settings.at("seed")));
    settings.erase("seed");
    StudyPicture made = render_study_picture(settings, folder_, seed, 1, true, cancel_);
    std::erase_if(made.film.planes, [](const Plane& plane) {
        return std::find(planes.begin(), planes.end(), plane.name) == planes.end();
    });
    write_exr(reference_file(store, reference), made.film, {{"razor.point", reference.body}});
    Result out;
    add_times(out.host, made.statistics);
    return out;
}

Result ImageStudy::measure(const Point& point, const analysis::Store& store) const {
    const StudyReferences references{read_references(references_of(point), store),
                                     read_references(pairs_of(point), store)};
    Result out;
    std::vector<analysis::ImageFile> pictures;
    const int seeds = takes_no_seed(study_, point) ? 1 : study_.seeds;
    for (int seed = 1; seed <= seeds; ++seed) {
        if (point.rival.empty()) {
            const StudyPicture made =
                render_study_picture(point.settings, folder_, seed, 1 + study_.repeats, seed == 1, cancel_);
            pictures.push_back(image_of(made.film, planes));
            add_times(out.host, made.statistics);
            const double taken = made.statistics.times.back().passes.mean_samples;
            const Value& asked = described(known_only(point.settings)).settings.at("samples");
            out.values["samples_taken"].push_back(
                taken > 0 ? taken : static_cast<double>(std::get<std::int64_t>(asked)));
            continue;
        }
        std::map<std::string, std::string> words;
        const analysis::Settings all =
            analysis::overlaid(described(known_only(point.settings)).settings, point.settings);
        for (const auto& [key, value] : all)
            words[key] = plain_text(value);
        words["scene"] = (folder_ / words["scene"]).string();
        words["seed"] = fmt::format("{}", seed);
        words["repeats"] = fmt::format("{}", study_.repeats);
        words.try_emplace("frame", "0");
        words.try_emplace("threads", "2");
        RivalRun run = run_rival(*analysis::find_rival(study_, point.rival), words, cancel_);
        pictures.push_back(std::move(run.picture));
        for (const auto& [figure, numbers] : run.figures)
            out.host[figure].insert(out.host[figure].end(), numbers.begin(), numbers.end());
    }
    add_errors(out.values, pictures, references);
    if (point.rival.empty())
        out.host["process_megabytes"] = {process_megabytes()};
    return out;
}

} // namespace razor
