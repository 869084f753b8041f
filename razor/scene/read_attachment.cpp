#include "razor/scene/read_attachment.h"

#include "razor/scene/nearest.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

namespace razor {
namespace {

class Resolver {
public:
    Resolver(const SceneDescription& scene, std::vector<ObjectDescription>& objects)
        : scene_(scene), objects_(objects) {
        for (std::size_t o = 0; o < objects.size(); ++o)
            names_[objects[o].name].push_back(o);
    }

    void find(const TomlTable& table, Attachment& on) const {
        on.carrier = carrier(table, on);
        const ObjectDescription& carrier = objects_[on.carrier];
        const auto named = std::find_if(scene_.meshes.begin(), scene_.meshes.end(),
                                        [&](const MeshDescription& m) { return m.name == carrier.mesh; });
        on.mesh = static_cast<std::size_t>(named - scene_.meshes.begin());
        const bool by_node = !on.node.empty();
        if (carrier.mesh.empty() || !(by_node ? named->nodes != nullptr : named->tags != nullptr))
            table.fail("attach", missing_places(on, carrier.mesh.empty() ? nullptr : &*named));
        if (carrier.copies != glm::ivec3(1))
            table.fail("attach",
                       fmt::format("'{}' is an array, and this would hang on one of many; put both into a "
                                   "[[group]] and that into the array",
                                   printable(on.object)));
        if (!named->deformers.empty())
            table.fail("attach", fmt::format("the mesh '{}' has deformations, which {}s do not follow; "
                                             "leave them out",
                                             printable(named->name), by_node ? "node" : "tag"));
        on.place = by_node ? node(table, on, *named) : tag(table, on, *named);
    }

    /// Throws where one hangs on itself by way of others. Each object is passed once.
    void refuse_cycles(std::span<const TomlTable> tables) const {
        constexpr std::size_t nobody = static_cast<std::size_t>(-1);
        std::vector<std::size_t> passed_from(objects_.size(), nobody);
        for (std::size_t first = 0; first < objects_.size(); ++first) {
            std::size_t o = first;
            while (passed_from[o] == nobody && objects_[o].attachment) {
                passed_from[o] = first;
                o = objects_[o].attachment->carrier;
            }
            if (passed_from[o] == first)
                tables[o].fail("attach",
                               fmt::format("'{}' hangs on itself: {}; attach one of them to nothing",
                                           printable(objects_[o].name), way_from(o)));
        }
    }

private:
    std::size_t carrier(const TomlTable& table, const Attachment& on) const {
        const auto found = names_.find(on.object);
        if (found == names_.end())
            table.fail("attach", fmt::format("there is no object '{}' {}; it has: {}", printable(on.object),
                                             "beside this one, in the group or the scene that holds it",
                                             list_of(names_, [](const auto& name) { return name.first; })));
        if (found->second.size() > 1)
            table.fail("attach",
                       fmt::format("{} objects beside this one are called '{}'; give them names of their own",
                                   found->second.size(), printable(on.object)));
        return found->second.front();
    }

    /// `mesh`: null where the carrier places no single one.
    static std::string missing_places(const Attachment& on, const MeshDescription* mesh) {
        if (on.node.empty())
            return fmt::format("'{}' has no tags to attach to; {}", printable(on.object),
                               mesh != nullptr && mesh->nodes
                                   ? "name one of its model's nodes, node = \"NAME\""
                                   : "name an object that places an .md3 model with tags");
        return fmt::format("'{}' has no nodes to attach to; {}", printable(on.object),
                           mesh != nullptr && mesh->tags ? "name one of its model's tags, tag = \"NAME\""
                                                         : "name an object that places a .gltf or .glb model "
                                                           "whose nodes have names");
    }

    static std::size_t node(const TomlTable& table, const Attachment& on, const MeshDescription& mesh) {
        const std::vector<NamedNode>& named = mesh.nodes->named();
        const auto is_it = [&](const NamedNode& n) { return n.name == on.node; };
        const auto first = std::find_if(named.begin(), named.end(), is_it);
        const auto times = std::count_if(named.begin(), named.end(), is_it);
        if (times == 0) {
            const std::vector<std::string_view> names = names_of(named);
            table.fail("node", fmt::format("the model of '{}' has no node '{}'; {}", printable(mesh.name),
                                           printable(on.node), or_known(on.node, names, "It has")));
        }
        if (times > 1)
            table.fail("node",
                       fmt::format("{} nodes of the model of '{}' are called '{}'; rename them in the "
                                   "file, or attach to another one",
                                   times, printable(mesh.name), printable(on.node)));
        const auto number = static_cast<std::size_t>(first - named.begin());
        if (const auto flat = mesh.nodes->flat_at(number, mesh.playback.moment))
            table.fail("node",
                       fmt::format("the axes of the node '{}' of '{}' are flat or not finite {} s after its "
                                   "motion's beginning; give it, and nodes above it, scales other than 0",
                                   printable(on.node), printable(mesh.name), *flat));
        return number;
    }

    static std::vector<std::string_view> names_of(const std::vector<NamedNode>& named) {
        std::vector<std::string_view> names;
        for (const NamedNode& n : named)
            names.push_back(n.name);
        return names;
    }

    static std::size_t tag(const TomlTable& table, const Attachment& on, const MeshDescription& mesh) {
        const Tags& tags = *mesh.tags;
        std::vector<std::string> names;
        for (std::size_t t = 0; t < tags.count(); ++t)
            names.push_back(tags.name(t));
        const auto number =
            static_cast<std::size_t>(std::find(names.begin(), names.end(), on.tag) - names.begin());
        if (number == names.size())
            table.fail("tag",
                       fmt::format("the mesh '{}' has no tag '{}'; it has: {}", printable(mesh.name),
                                   printable(on.tag), list_of(names, [](const auto& name) { return name; })));
        if (const auto frame = tags.bad_frame(number))
            table.fail("tag",
                       fmt::format("the axes of the tag '{}' of '{}' are flat, mirrored or not finite in "
                                   "frame {}; export the model again",
                                   printable(on.tag), printable(mesh.name),
                                   static_cast<std::size_t>(mesh.playback.frames->first) + *frame));
        return number;
    }

    template <class List, class NameOf> static std::string list_of(const List& list, NameOf name_of) {
        constexpr std::size_t most_bytes = 500;
        std::string text;
        for (const auto& entry : list)
            if (text.size() <= most_bytes)
                text += fmt::format("{}{}", text.empty() ? "" : ", ", name_of(entry));
        return printable(text, most_bytes);
    }

    std::string way_from(std::size_t first) const {
        std::string text = objects_[first].name;
        std::size_t o = first;
        do {
            o = objects_[o].attachment->carrier;
            text += " on " + objects_[o].name;
        } while (o != first);
        return printable(text, 500);
    }

    const SceneDescription& scene_;
    std::vector<ObjectDescription>& objects_;
    std::map<std::string, std::vector<std::size_t>, std::less<>> names_;
};

} // namespace

std::optional<Attachment> read_attachment(TomlTable& table) {
    const bool stated = table.has("attach"), by_tag = table.has("tag"), by_node = table.has("node");
    if (by_tag && by_node)
        table.fail("node", "an object hangs on a tag or on a node, not on both; leave one out");
    if (stated != (by_tag || by_node))
        table.fail(
            stated   ? "attach"
            : by_tag ? "tag"
                     : "node",
            "attach names another object, tag or node where on its model this one hangs; write attach and "
            "one of them, or nothing");
    Attachment on;
    on.object = table.text("attach", "");
    on.tag = table.text("tag", "");
    on.node = table.text("node", "");
    if (by_node && on.node.empty())
        table.fail("node", "the name of the node is empty; write that of one of the model's nodes");
    return stated ? std::optional(on) : std::nullopt;
}

void resolve_attachments(std::span<const TomlTable> tables, const SceneDescription& scene,
                         std::vector<ObjectDescription>& objects) {
    if (std::none_of(objects.begin(), objects.end(),
                     [](const ObjectDescription& o) { return o.attachment.has_value(); }))
        return;
    const Resolver resolver(scene, objects);
    for (std::size_t o = 0; o < objects.size(); ++o)
        if (objects[o].attachment)
            resolver.find(tables[o], *objects[o].attachment);
    resolver.refuse_cycles(tables);
}

} // namespace razor
