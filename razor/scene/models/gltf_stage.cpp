#include "razor/scene/models/gltf_stage.h"

#include "razor/scene/error.h"
#include "razor/scene/models/gltf/nodes.h"
#include "razor/scene/models/gltf/stage.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <new>
#include <stdexcept>

namespace razor {
namespace {

using namespace gltf;

GltfStage read(const std::filesystem::path& path, const std::string& clip, double cycle) {
    const Document document = load_document(path);
    GltfStage result{nullptr, clip_names(document)};
    Skeleton skeleton = read_skeleton(document);
    Stage stage = read_stage(document, nodes_to_draw(document, skeleton));
    std::optional<Clip> moving;
    if (!result.clips.empty() || !clip.empty())
        moving =
            gltf::read_clip(document, skeleton, clip.empty() ? 0 : find_clip(document, result.clips, clip));
    if (!stage.cameras.empty() || !stage.lights.empty())
        result.stage = std::make_shared<const ModelStage>(std::move(skeleton), std::move(moving), cycle,
                                                          std::move(stage.cameras), std::move(stage.lights));
    return result;
}

} // namespace

GltfStage read_gltf_stage(const std::filesystem::path& path, const std::string& clip, double cycle) {
    const auto too_large = [&path] {
        return UserError(fmt::format("{}: the model does not fit in memory; give a smaller one",
                                     printable(path.string(), 1000)));
    };
    try {
        return read(path, clip, cycle);
    } catch (const std::bad_alloc&) {
        throw too_large();
    } catch (const std::length_error&) {
        throw too_large();
    }
}

} // namespace razor
