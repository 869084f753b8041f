#include "razor/scene/models/md3_materials.h"

#include "razor/scene/error.h"
#include "razor/scene/models/game_files.h"
#include "razor/scene/models/md3_skin.h"
#include "razor/scene/models/own_materials.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {
namespace {

/// Empty: there is none.
std::filesystem::path skin_of(const std::filesystem::path& model) {
    const std::string stem = model.stem().string();
    std::vector<std::string> stems{stem};
    if (stem.ends_with("_1") || stem.ends_with("_2"))
        stems.push_back(stem.substr(0, stem.size() - 2));
    for (const std::string& of : stems)
        for (const char* const end : {"_default.skin", ".skin"}) {
            std::error_code error;
            std::filesystem::path file = model.parent_path() / (of + end);
            if (std::filesystem::is_regular_file(file, error))
                return file;
        }
    return {};
}

void take_skin(const std::filesystem::path& skin, const std::vector<Md3Surface>& surfaces,
               std::vector<Md3Paint>& paints, std::vector<std::string>& notes) {
    const std::string name = printable(skin.string(), 1000);
    std::vector<std::string> unknown;
    for (const Md3SkinLine& line : parse_md3_skin(read_text_file(skin, "a skin"), skin.string())) {
        bool known = false;
        for (std::size_t s = 0; s < surfaces.size(); ++s)
            if (same_but_for_case(surfaces[s].name, line.surface)) {
                known = true;
                paints[s] = {line.picture, fmt::format("{}:{}", name, line.line), {}};
            }
        if (!known)
            unknown.push_back(line.surface);
    }
    if (!unknown.empty())
        notes.push_back(fmt::format("{}: the model has no surface {}; mend the name", name, quoted(unknown)));
}

/// The number of the picture among the model's textures.
int use(const Md3Paint& paint, ModelMaterials& own, TextureCache& cache) {
    Texture texture;
    texture.name = paint.picture.stem().string();
    texture.file = paint.picture.string();
    auto known = std::find_if(own.textures.begin(), own.textures.end(),
                              [&](const Texture& t) { return t.file == texture.file; });
    if (known == own.textures.end()) {
        try {
            texture.pyramid = cache.read(texture.file, texture.linear);
        } catch (const UserError& error) {
            throw UserError(fmt::format("{}: {}", paint.stated_at, error.what()));
        }
        known = own.textures.insert(known, std::move(texture));
    }
    return static_cast<int>(known - own.textures.begin());
}

} // namespace

std::vector<Md3Paint> find_md3_paints(const std::filesystem::path& file, const Md3Model& model,
                                      std::vector<std::string>& notes) {
    const std::string name = printable(file.string(), 1000);
    std::vector<Md3Paint> paints;
    for (const Md3Surface& surface : model.surfaces)
        paints.push_back({surface.shaders.empty() ? "" : surface.shaders.front(),
                          fmt::format("{}: surface '{}'", name, printable(surface.name, 64)),
                          {}});
    if (const std::filesystem::path skin = skin_of(file); !skin.empty())
        take_skin(skin, model.surfaces, paints, notes);
    for (Md3Paint& paint : paints)
        paint.picture = find_game_picture(file.parent_path(), paint.shader);
    std::vector<bool> seen(paints.size());
    for (const int surface : model.face_surfaces)
        seen[static_cast<std::size_t>(surface)] = true;
    std::vector<std::string> missing;
    for (std::size_t s = 0; s < paints.size(); ++s)
        if (const Md3Paint& paint = paints[s];
            seen[s] && paint.picture.empty() && !paint.shader.empty() &&
            std::find(missing.begin(), missing.end(), paint.shader) == missing.end())
            missing.push_back(paint.shader);
    if (!missing.empty())
        notes.push_back(
            fmt::format("{}: no picture {}; put it beside the model, or where its path leads from "
                        "there or from a folder above",
                        name, quoted(missing)));
    return paints;
}

void paint(Md3Model& model, const std::filesystem::path& file, TextureCache& textures) {
    ModelMaterials own;
    const std::vector<Md3Paint> paints = find_md3_paints(file, model, own.notes);
    std::vector<int> of_surface(model.surfaces.size(), -1);
    for (const int surface : model.face_surfaces) {
        const auto s = static_cast<std::size_t>(surface);
        if (of_surface[s] < 0) {
            of_surface[s] = static_cast<int>(own.materials.size());
            Material& material = own.materials.emplace_back();
            material.name = !paints[s].shader.empty()         ? paints[s].shader
                            : !model.surfaces[s].name.empty() ? model.surfaces[s].name
                                                              : fmt::format("surface {}", s + 1);
            if (!paints[s].picture.empty()) {
                material.albedo_map.texture = use(paints[s], own, textures);
                material.albedo = glm::vec3(1);
            }
            own.parts.push_back(model.surfaces[s].name);
        }
        model.cage.face_materials.push_back(of_surface[s]);
    }
    set_own_materials(model.cage, std::make_shared<const ModelMaterials>(std::move(own)));
}

} // namespace razor
