#include "razor/scene/read_from_model.h"

#include "razor/scene/animation/read_playback.h"
#include "razor/scene/error.h"
#include "razor/scene/models/model_file.h"
#include "razor/scene/text_file.h"
#include "razor/scene/toml_text.h"

#include <fmt/format.h>

namespace razor {
namespace {

constexpr Range lumens_range{1e-6, 1e6}; // a watt

} // namespace

FromModel read_from_model(TomlTable& table, const std::filesystem::path& folder, bool camera) {
    FromModel from;
    const std::string file = table.text("from", "");
    from.name = table.text("name", "");
    read_clip_playback(table, from.playback);
    from.scale = table.number("scale", from.scale, scale_range);
    from.rotate = table.vector("rotate", from.rotate, angle_range);
    from.translate = table.vector("translate", from.translate, coordinate_range);
    if (!camera)
        from.lumens_per_watt = table.number("lumens_per_watt", from.lumens_per_watt, lumens_range);
    try {
        if (model_file(file) != ModelFile::gltf)
            throw UserError(fmt::format("'{}' brings no {}; give a .gltf or .glb file", printable(file, 1000),
                                        camera ? "camera" : "lights"));
        from.file = std::filesystem::absolute(folder / file).lexically_normal().string();
        load_stage(from, camera);
    } catch (const UserError& error) {
        table.fail(table.key_in(error.what(), {"clip", "name"}, "from"), error.what());
    }
    return from;
}

std::string to_toml(const FromModel& from, bool camera) {
    std::string text = fmt::format("from = {}\n", toml_text(from.file));
    if (!from.name.empty())
        text += fmt::format("name = {}\n", toml_text(from.name));
    text += clip_playback_to_toml(from.playback);
    text += fmt::format("scale = {}\nrotate = {}\ntranslate = {}\n", toml_number(from.scale),
                        toml_value(from.rotate), toml_value(from.translate));
    if (!camera)
        text += fmt::format("lumens_per_watt = {}\n", toml_number(from.lumens_per_watt));
    return text;
}

} // namespace razor
