#include "razor/scene/models/cage_source.h"

#include "razor/scene/animation/cage_frames.h"
#include "razor/scene/error.h"
#include "razor/scene/models/gltf_reader.h"
#include "razor/scene/models/md3_materials.h"
#include "razor/scene/models/still_cage.h"
#include "razor/scene/numbered_name.h"
#include "razor/scene/shapes/shapes.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {
namespace {

std::pair<int, int> all_frames(const std::string& file) {
    const std::vector<int> numbers = numbers_there(file);
    if (numbers.empty())
        throw UserError(
            fmt::format("{}: there is no such file of any number; check the path", printable(file, 1000)));
    const auto gap = std::adjacent_find(numbers.begin(), numbers.end(),
                                        [](int number, int next) { return next != number + 1; });
    if (gap == numbers.end())
        return {numbers.front(), numbers.back()};
    throw UserError(
        fmt::format("{}: no such file, but there are some up to number {}; add it, or write which "
                    "to read into a scene file's [[mesh]]: frames = [{}, {}]",
                    printable(numbered(file, *gap + 1), 1000), numbers.back(), numbers.front(), *gap));
}

/// All that what is read depends on.
std::string key_of(const MeshDescription& mesh) {
    const Playback& p = mesh.playback;
    const auto [first, last] = p.frames.value_or(std::pair(-1, -1));
    return fmt::format("{}\n{}\n{} {} {} {} {} {} {}", mesh.file, p.clip_file, first, last, p.frame_rate,
                       static_cast<int>(p.timing.interpolation), p.timing.cycle, mesh.crease_angle, p.clip);
}

/// Leaves what belongs to frames first to last, of which there are more or as many.
template <class Frame> void keep(std::vector<Frame>& frames, const std::pair<int, int>& kept) {
    frames.erase(frames.begin() + kept.second + 1, frames.end());
    frames.erase(frames.begin(), frames.begin() + kept.first);
}

CageCache::Entry read_md3_frames(const MeshDescription& mesh, TextureCache& textures) {
    CageCache::Entry entry{.playback = mesh.playback};
    Playback& p = entry.playback;
    Md3Model model = read_md3(mesh.file, mesh.crease_angle);
    paint(model, mesh.file, textures);
    const int last = static_cast<int>(model.frames.size()) - 1;
    if (!p.frames)
        p.frames = {0, last};
    if (p.frames->second > last)
        throw UserError(fmt::format("{}: has no frame {}; give frames from 0 to {}",
                                    printable(mesh.file, 1000), p.frames->second, last));
    entry.source = std::make_shared<const Mesh>(std::move(model.cage));
    for (TagFrames& tag : model.tags)
        keep(tag.frames, *p.frames);
    if (!model.tags.empty())
        entry.tags = std::make_shared<const Tags>(std::move(model.tags), p.frame_rate, p.timing);
    if (p.frames->first == p.frames->second) {
        entry.source =
            moved(*entry.source, std::move(model.frames[static_cast<std::size_t>(p.frames->first)]));
        return entry;
    }
    keep(model.frames, *p.frames);
    entry.motion =
        std::make_shared<const PointFrames>(entry.source, std::move(model.frames), p.frame_rate, p.timing);
    return entry;
}

CageCache::Entry read_clip(const MeshDescription& mesh, TextureCache& textures) {
    CageCache::Entry entry{.playback = mesh.playback};
    Playback& p = entry.playback;
    GltfModel model = read_gltf(mesh.file, p.clip, p.timing.cycle, &textures, p.clip_file, mesh.crease_angle);
    if (p.clip.empty() && !model.clips.empty())
        p.clip = model.clips.front();
    entry.source = model.cage;
    entry.motion = model.motion;
    entry.nodes = model.nodes;
    return entry;
}

CageCache::Entry read_sequence(const MeshDescription& mesh, TextureCache& textures) {
    CageCache::Entry entry{.playback = mesh.playback};
    Playback& p = entry.playback;
    if (!p.frames)
        p.frames = all_frames(mesh.file);
    entry.motion = std::make_shared<const CageSequence>(mesh.file, p.frames->first, p.frames->second,
                                                        p.frame_rate, p.timing, &textures);
    entry.source = entry.motion->at(0);
    return entry;
}

CageCache::Entry read(const MeshDescription& mesh, TextureCache& textures) {
    switch (model_file(mesh.file)) {
    case ModelFile::sequence:
        return read_sequence(mesh, textures);
    case ModelFile::md3:
        return read_md3_frames(mesh, textures);
    case ModelFile::gltf:
        return read_clip(mesh, textures);
    case ModelFile::none:
    case ModelFile::still:
        break;
    }
    return {.playback = mesh.playback,
            .source = std::make_shared<const Mesh>(read_still_cage(mesh.file, textures))};
}

} // namespace

void load_cage(MeshDescription& mesh) {
    CageCache none;
    load_cage(mesh, none);
}

void load_cage(MeshDescription& mesh, CageCache& cages) {
    if (mesh.file.empty()) {
        mesh.source = std::make_shared<const Mesh>(make_shape(mesh.shape, mesh.parameters));
    } else {
        CageCache::Entry& entry = cages.entries[key_of(mesh)];
        if (!entry.source)
            entry = read(mesh, cages.textures);
        mesh.source = entry.source;
        mesh.motion = entry.motion;
        mesh.tags = entry.tags;
        mesh.nodes = entry.nodes;
        // Start, speed and moment are the mesh's own.
        mesh.playback.frames = entry.playback.frames;
        mesh.playback.clip = entry.playback.clip;
    }
    shape_cage(mesh, 0);
}

void shape_cage(MeshDescription& mesh, double scene_seconds) {
    const double seconds = mesh.playback.seconds(scene_seconds);
    mesh.cage = mesh.motion ? mesh.motion->at(seconds) : mesh.source;
    if (mesh.deformers.empty())
        return;
    std::vector<glm::dvec3> points = mesh.cage->points;
    for (const Deformer& d : mesh.deformers)
        deform(d, seconds, points);
    mesh.cage = moved(*mesh.cage, std::move(points));
}

void pose_cage(MeshDescription& mesh, double scene_seconds) {
    shape_cage(mesh, scene_seconds);
    mesh.playback.moment = mesh.playback.seconds(scene_seconds);
}

double motion_length(const MeshDescription& mesh) {
    double length = mesh.motion ? mesh.motion->length() : 0;
    for (const Deformer& d : mesh.deformers)
        length = std::max(length, d.period);
    return length;
}

std::string cage_name(const std::filesystem::path& path) {
    const std::string stem = path.stem().string();
    std::string name = without_number(stem);
    return name.empty() ? stem : name;
}

} // namespace razor
