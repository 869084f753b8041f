#include "razor/scene/read_attachment.h"

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
        if (carrier.mesh.empty() || !named->tags)
            table.fail("attach", fmt::format("'{}' has no tags to attach to; name an object that places an "
                                             ".md3 model with tags",
                                             printable(on.object)));
        if (carrier.copies != glm::ivec3(1))
            table.fail("attach",
                       fmt::format("'{}' is an array, and this would hang on one of many; put both into a "
                                   "[[group]] and that into the array",
                                   printable(on.object)));
        if (!named->deformers.empty())
            table.fail("attach",
                       fmt::format("the mesh '{}' has deformations, which tags do not follow; leave "
                                   "them out",
                                   printable(named->name)));
        on.tag_number = tag(table, on, *named);
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
                text += (text.empty() ? "" : ", ") + name_of(entry);
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
    const bool stated = table.has("attach");
    if (stated != table.has("tag"))
        table.fail(stated ? "attach" : "tag",
                   "attach names another object and tag where this one hangs on it; write both or neither");
    Attachment on;
    on.object = table.text("attach", "");
    on.tag = table.text("tag", "");
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
