#include "razor/scene/models/gltf/joints.h"

#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <map>
#include <set>

namespace razor::gltf {
namespace {

std::set<int> joints_of(const Document& document) {
    std::set<int> joints;
    for (const SkinEntry& skin : document.skins)
        joints.insert(skin.joints.begin(), skin.joints.end());
    if (joints.empty())
        for (std::size_t n = 0; n < document.nodes.size(); ++n)
            joints.insert(static_cast<int>(n));
    return joints;
}

constexpr int twice = -2;

/// Those that have a name.
std::map<std::string, int> by_name(const Document& document) {
    std::map<std::string, int> result;
    for (const int joint : joints_of(document)) {
        const std::string& name = entry(document, document.nodes, joint, "node", "a skin").name;
        if (const auto [known, is_new] = result.try_emplace(name, joint); !is_new)
            known->second = twice;
    }
    result.erase("");
    return result;
}

} // namespace

std::vector<int> match_joints(const Document& document, const Document& other) {
    const std::map<std::string, int> own = by_name(document), others = by_name(other);
    std::vector<int> result(document.nodes.size(), none);
    bool any = false;
    for (const auto& [name, joint] : own) {
        const auto found = others.find(name);
        if (found == others.end())
            continue;
        for (const auto& [file, number] : {std::pair(&document, joint), std::pair(&other, found->second)})
            if (number == twice)
                file->fail(fmt::format("two joints are called '{}'; rename one", printable(name)));
        result[static_cast<std::size_t>(joint)] = found->second;
        any = true;
    }
    if (any)
        return result;
    std::string list;
    for (const auto& [name, joint] : own) {
        if (list.size() > 60) {
            list += ", ...";
            break;
        }
        list += fmt::format("{}{}", list.empty() ? "" : ", ", printable(name));
    }
    document.fail(fmt::format("none of its joints is called as one of {}; rename them; it has: {}",
                              printable(other.file, 1000), list.empty() ? "none with a name" : list));
}

} // namespace razor::gltf
