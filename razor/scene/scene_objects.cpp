#include "razor/scene/scene_objects.h"

#include "razor/scene/animation/read_keys.h"
#include "razor/scene/error.h"
#include "razor/scene/read_attachment.h"
#include "razor/scene/text_file.h"
#include "razor/scene/toml_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace razor {
namespace {

class ObjectsReader {
public:
    ObjectsReader(SceneDescription& scene, const std::filesystem::path& folder, CageCache& cages)
        : scene_(scene), folder_(folder), cages_(cages) {
        for (const MeshDescription& mesh : scene.meshes) {
            mesh_names_.push_back(mesh.name);
        }
    }

    void read(TomlTable& root) {
        std::vector<TomlTable> groups = root.tables("group");
        for (TomlTable& group : groups) {
            group_names_.push_back(read_group_name(group));
        }
        for (std::size_t g = 0; g < groups.size(); ++g) {
            GroupDescription group{group_names_[g], read_list(groups[g])};
            groups[g].finish();
            if (group.objects.empty()) {
                groups[g].fail("name",
                               fmt::format("the group '{}' is empty; write at least one [[group.object]] "
                                           "below it",
                                           printable(group.name)));
            }
            scene_.groups.push_back(std::move(group));
        }
        scene_.objects = read_list(root);
        if (!scene_.groups.empty() || !scene_.objects.empty()) {
            check(root, groups);
        }
    }

private:
    std::string read_group_name(TomlTable& group) {
        const std::string name = group.text("name", "");
        if (name.empty()) {
            group.fail("name", "a group without a name; write name = \"...\"");
        }
        if (std::find(group_names_.begin(), group_names_.end(), name) != group_names_.end()) {
            group.fail("name", fmt::format("the name '{}' is used twice; choose another", printable(name)));
        }
        return name;
    }

    /// The word stated for `key`, which must be one of `names` and only once among them.
    static std::string reference(TomlTable& table, std::string_view key,
                                 const std::vector<std::string>& names) {
        if (!table.has(key)) {
            table.may_have(key);
            return {};
        }
        const std::string name = table.text(key, "");
        const auto times = std::count(names.begin(), names.end(), name);
        if (times > 1) {
            table.fail(key, fmt::format("{} [[{}]] are called '{}'; give them names of their own", times, key,
                                        printable(name)));
        }
        if (names.empty()) {
            table.fail(key, fmt::format("there is no {0} '{1}'; write a [[{0}]] of that name", key,
                                        printable(name)));
        }
        const std::vector<std::string_view> words(names.begin(), names.end());
        return std::string(words[table.choice(key, 0, words)]);
    }

    /// Of a group, or of the scene.
    std::vector<ObjectDescription> read_list(TomlTable& owner) {
        const std::vector<TomlTable> tables = owner.tables("object");
        std::vector<ObjectDescription> objects;
        objects.reserve(tables.size());
        for (const TomlTable& table : tables) {
            objects.push_back(read_object(table));
        }
        resolve_attachments(tables, scene_, objects);
        return objects;
    }

    ObjectDescription read_object(TomlTable table) {
        ObjectDescription object;
        object.name = table.text("name", "");
        if (static_cast<int>(table.has("mesh")) + static_cast<int>(table.has("group")) +
                static_cast<int>(table.has("instances")) !=
            1) {
            table.fail(
                "", "an object needs one of mesh = \"name\", group = \"name\" or instances = \"file\"; write "
                    "one of them");
        }
        object.mesh = reference(table, "mesh", mesh_names_);
        object.group = reference(table, "group", group_names_);
        object.transform = read_transform(table);
        object.keys = read_transform_keys(table);
        if (object.keys.any() && object.transform.matrix) {
            table.fail("matrix",
                       "an object with a matrix and keys; write scale, rotate and translate instead");
        }
        object.attachment = read_attachment(table);
        object.copies = table.whole_vector("array", object.copies, copies_range);
        object.spacing = table.vector("spacing", object.spacing, coordinate_range);
        if (table.has("spacing") && !table.has("array"))
            table.fail("spacing",
                       "spacing of one object; write array = [x, y, z], how many there are, or leave "
                       "it out");
        object.level_offset = table.whole("level_offset", object.level_offset, level_offset_range);
        object.rate = table.number("rate", object.rate, rate_range);
        if (table.has("material")) {
            std::vector<std::string_view> names;
            for (const Material& material : scene_.materials) {
                names.push_back(material.name);
            }
            object.material = std::string(names[table.choice("material", 0, names)]);
        }
        table.may_have("material");
        read_instances(table, object);
        table.finish();
        for (int axis = 0; axis < 3; ++axis) {
            if (object.copies[axis] > 1 && object.spacing[axis] == 0) {
                table.fail(
                    "array",
                    fmt::format("an array of {} along {} without spacing there puts copies in one place; "
                                "write spacing = [x, y, z]",
                                object.copies[axis], "xyz"[axis]));
            }
        }
        if (object.name.empty()) {
            object.name = object.table ? std::filesystem::path(object.instances).stem().string()
                                       : object.mesh + object.group;
        }
        return object;
    }

    static Transform read_transform(TomlTable& table) {
        Transform transform;
        if (const auto rows = table.rows_of_four("matrix", coordinate_range)) {
            for (const std::string_view key : {"scale", "rotate", "translate"}) {
                if (table.has(key)) {
                    table.fail(key, fmt::format("a matrix and {} in one object; write either", key));
                }
            }
            Affine& matrix = transform.matrix.emplace();
            for (int row = 0; row < 3; ++row) {
                const auto& numbers = (*rows)[static_cast<std::size_t>(row)];
                for (int column = 0; column < 3; ++column) {
                    matrix.linear[column][row] = numbers[static_cast<std::size_t>(column)];
                }
                matrix.translation[row] = numbers[3];
            }
        }
        transform.scale = table.vector_or_number("scale", transform.scale, signed_scale_range);
        transform.rotate = table.vector("rotate", transform.rotate, angle_range);
        transform.translate = table.vector("translate", transform.translate, coordinate_range);
        if (is_degenerate(to_affine(transform).linear)) {
            table.fail(transform.matrix ? "matrix" : "scale",
                       fmt::format(
                           "the object's {} flattens it (its least scale is below {:g} of the largest); make "
                           "it thicker",
                           transform.matrix ? "matrix" : "scale", least_relative_scale));
        }
        return transform;
    }

    void read_instances(TomlTable& table, ObjectDescription& object) {
        const std::string file = table.text("instances", "");
        const Scheme scheme = choose(table, "scheme", Scheme::catmull_clark, scheme_words);
        if (!table.has("instances")) {
            if (table.has("scheme")) {
                table.fail("scheme", "an object of a mesh or group has no scheme; state it in the [[mesh]]");
            }
            return;
        }
        try {
            if (file.empty()) {
                throw UserError("the file name is empty; give a table of instances");
            }
            object.instances = std::filesystem::absolute(folder_ / file).lexically_normal().string();
            std::shared_ptr<const InstanceTable>& known = tables_[object.instances];
            if (!known) {
                known = std::make_shared<const InstanceTable>(read_instance_table(object.instances));
            }
            object.table = known;
            add_table_meshes(scene_, *object.table, object.instances, scheme, scene_.materials.front().name,
                             cages_);
        } catch (const UserError& error) {
            table.fail("instances", error.what());
        }
        if (table.has("scheme")) {
            check_scheme(table, scheme, *object.table);
        }
    }

    /// Tables place the first mesh of each file, as it is.
    void check_scheme(const TomlTable& object, Scheme stated, const InstanceTable& placed) const {
        for (const std::string& file : placed.files) {
            const auto mesh = std::find_if(scene_.meshes.begin(), scene_.meshes.end(),
                                           [&](const MeshDescription& m) { return m.file == file; });
            if (mesh != scene_.meshes.end() && mesh->scheme != stated) {
                object.fail("scheme",
                            fmt::format("{} is there already, as a mesh with scheme = \"{}\", which the "
                                        "table places; state the same here, or none",
                                        printable(file, 1000), word_of(scheme_words, mesh->scheme)));
            }
        }
    }

    void check(TomlTable& root, const std::vector<TomlTable>& groups) {
        const SceneGraph graph = build_graph(scene_);
        const std::vector<int> cycle = find_cycle(graph);
        try {
            flatten(graph, mesh_bounds(scene_));
        } catch (const UserError& error) {
            if (!cycle.empty()) { // tables and the root place groups, but no group places them
                groups[static_cast<std::size_t>(cycle.front() - 1)].fail("name", error.what());
            }
            root.fail(scene_.objects.empty() ? "group" : "object", error.what());
        }
    }

    SceneDescription& scene_;
    const std::filesystem::path& folder_;
    CageCache& cages_;
    std::vector<std::string> mesh_names_, group_names_;
    std::map<std::string, std::shared_ptr<const InstanceTable>> tables_;
};

} // namespace

void read_objects(TomlTable& root, SceneDescription& scene, const std::filesystem::path& folder,
                  CageCache& cages) {
    ObjectsReader(scene, folder, cages).read(root);
}

void add_table_meshes(SceneDescription& scene, const InstanceTable& table, const std::string& path,
                      Scheme scheme, const std::string& material, CageCache& cages) {
    std::set<std::string> known;
    for (const MeshDescription& mesh : scene.meshes) {
        known.insert(mesh.file);
    }
    for (std::size_t f = 0; f < table.files.size(); ++f) {
        if (known.contains(table.files[f])) {
            continue;
        }
        MeshDescription mesh;
        mesh.file = table.files[f];
        mesh.scheme = scheme;
        try {
            load_cage(mesh, cages);
        } catch (const UserError& error) {
            const auto row = std::find_if(table.rows.begin(), table.rows.end(), [&](const InstanceRow& r) {
                return static_cast<std::size_t>(r.file) == f;
            });
            throw UserError(fmt::format("{}:{}: {}", printable(path, 1000), row->line, error.what()));
        }
        mesh.name = cage_name(mesh.file);
        if (!mesh.source->own_materials) {
            mesh.material = material;
        }
        scene.meshes.push_back(std::move(mesh));
    }
}

} // namespace razor
