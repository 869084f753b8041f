#include "razor/scene/models/obj_materials.h"

#include "razor/scene/models/mtl_reader.h"
#include "razor/scene/models/own_materials.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace razor {
namespace {

constexpr std::string_view an_obj_file = "an OBJ file";

/// Files that an mtllib line names: all of it one, or each word one; and the names of those that are not
/// there.
std::vector<std::filesystem::path> libraries_there(const std::filesystem::path& folder,
                                                   const std::string& named,
                                                   std::vector<std::string>& missing) {
    std::vector<std::filesystem::path> files;
    const auto add = [&](const std::string& name) {
        const std::filesystem::path file = find_beside(folder, name);
        if (!file.empty())
            files.push_back(file);
        return !file.empty();
    };
    if (add(named))
        return files;
    std::istringstream words(named);
    for (std::string word; words >> word;)
        if (!add(word))
            missing.push_back(word);
    return files;
}

/// Of materials that faces name and no library has.
void note_unknown(ModelMaterials& own, const std::vector<std::string>& names, const std::string& file) {
    std::vector<std::string> unknown;
    for (const std::string& name : names)
        if (std::none_of(own.materials.begin(), own.materials.end(),
                         [&](const Material& m) { return m.name == name; }))
            unknown.push_back(name);
    if (!unknown.empty())
        own.notes.push_back(fmt::format("{}: its libraries have no material {}; add it to one",
                                        printable(file, 1000), quoted(unknown)));
}

/// Indices into names become those into own materials.
void use(Mesh& mesh, const std::vector<std::string>& names, std::shared_ptr<const ModelMaterials> own) {
    std::vector<int> of_name;
    for (const std::string& name : names) {
        const auto found = std::find_if(own->materials.begin(), own->materials.end(),
                                        [&](const Material& m) { return m.name == name; });
        of_name.push_back(found == own->materials.end() ? -1
                                                        : static_cast<int>(found - own->materials.begin()));
    }
    for (int& material : mesh.face_materials)
        material = material < 0 ? material : of_name[static_cast<std::size_t>(material)];
    set_own_materials(mesh, std::move(own));
}

} // namespace

Mesh read_obj(const std::filesystem::path& path, TextureCache& textures) {
    ObjMaterialNames stated;
    Mesh mesh = parse_obj(read_text_file(path, an_obj_file), path.string(), &stated);
    ModelMaterials own;
    if (!stated.names.empty()) {
        MtlReader reader(stated.names, textures);
        std::vector<std::string> missing;
        for (const std::string& library : stated.libraries)
            for (const std::filesystem::path& file : libraries_there(path.parent_path(), library, missing))
                reader.read(file);
        own = reader.finish();
        if (!missing.empty())
            own.notes.push_back(
                fmt::format("{}: goes on without its material library {}; put it beside the model",
                            printable(path.string(), 1000), quoted(missing)));
        else if (!stated.libraries.empty())
            note_unknown(own, stated.names, path.string());
    }
    use(mesh, stated.names, std::make_shared<const ModelMaterials>(std::move(own)));
    return mesh;
}

Mesh read_obj(const std::filesystem::path& path, std::shared_ptr<const ModelMaterials> known) {
    if (!known)
        return read_obj(path);
    ObjMaterialNames stated;
    Mesh mesh = parse_obj(read_text_file(path, an_obj_file), path.string(), &stated);
    use(mesh, stated.names, std::move(known));
    return mesh;
}

} // namespace razor
