// MD3 models: any bytes are frames of one sound cage or one clear line.
#include "razor/scene/animation/tags.h"
#include "razor/scene/error.h"
#include "razor/scene/models/md3_reader.h"
#include "tests/fuzz/cage.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/sound_md3.h"

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        razor::write_md3(razor::two_surfaces(), 2),
        razor::write_md3(razor::two_surfaces(), 2, {{"tag_a", {{}, {}}}, {"tag_b", {{}, {}}}})};
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    try {
        // Normals make hard edges, or are passed over.
        const double crease = bytes.size() % 2 == 0 ? razor::no_crease_angle : 30.0;
        const razor::Md3Model model = razor::parse_md3(bytes, "fuzz", crease);
        require(razor::sound(model));
        require_sound(model.cage);
        for (const razor::Md3Surface& surface : model.surfaces)
            for (const std::string& shader : surface.shaders)
                require(shader.size() <= 64);
        const std::size_t frames = model.frames.size();
        for (const razor::TagFrames& tag : model.tags)
            require(tag.frames.size() == frames);
        const razor::Tags tags(model.tags, 24, {});
        for (std::size_t t = 0; t < tags.count(); ++t)
            if (!tags.bad_frame(t))
                require(glm::length(tags.at(t, 0.4 / 24).linear[0]) > 0.99);
    } catch (const razor::UserError& error) {
        require_line(error.what(), "fuzz:");
    }
    return true;
}
