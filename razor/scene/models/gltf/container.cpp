#include "razor/scene/models/gltf/container.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace razor::gltf {
namespace {

constexpr std::size_t header_size = 12, chunk_header_size = 8;
constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
constexpr std::string_view magic = "glTF";
constexpr int deepest = 64; // levels of brackets; glTF itself has about eight

constexpr std::array<std::string_view, 11> needed{
    "asset",   "extensionsUsed", "extensionsRequired",
    "buffers", "bufferViews",    "accessors",
    "meshes",  "nodes",          "scenes",
    "skins",   "animations",
};

/// Read apart; here extensions count, as those of the file and of nodes.
constexpr std::array<std::string_view, 4> of_appearance{"materials", "textures", "images", "samplers"};

[[noreturn]] void fail(std::string_view file, std::string_view mistake) {
    throw UserError(fmt::format("{}: {}", printable(file, 1000), mistake));
}

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
    std::uint32_t word = 0;
    for (std::size_t i = 4; i-- > 0;)
        word = word << 8 | static_cast<unsigned char>(bytes[offset + i]);
    return word;
}

void append_word(std::string& bytes, std::size_t word) {
    for (int i = 0; i < 4; ++i)
        bytes += static_cast<char>(word >> (8 * i) & 255);
}

void append_chunk(std::string& bytes, std::uint32_t type, std::string_view content, char padding) {
    const std::size_t padded = (content.size() + 3) / 4 * 4;
    append_word(bytes, padded);
    append_word(bytes, type);
    bytes += content;
    bytes.append(padded - content.size(), padding);
}

/// The parser passes over members of wrong types: those that would draw something else are found before.
class TypeCheck {
public:
    TypeCheck(const nlohmann::json& text, std::string_view file) : text_(text), file_(file) {}

    void run() {
        each(text_, "nodes", "node", [&](const nlohmann::json& node, const std::string& what) {
            for (const char* const key : {"translation", "rotation", "scale", "matrix"})
                numbers(node, key, what);
        });
        each(text_, "bufferViews", "buffer view", [&](const nlohmann::json& view, const std::string& what) {
            for (const char* const key : {"byteOffset", "byteLength", "byteStride"})
                bytes(view, key, what);
        });
        each(text_, "accessors", "accessor", [&](const nlohmann::json& accessor, const std::string& what) {
            bytes(accessor, "byteOffset", what);
            const auto sparse = accessor.find("sparse");
            if (sparse == accessor.end() || !sparse->is_object())
                return;
            for (const char* const part : {"indices", "values"})
                if (const auto found = sparse->find(part); found != sparse->end() && found->is_object())
                    bytes(*found, "byteOffset", what + " sparse " + part);
        });
        each(text_, "skins", "skin", [&](const nlohmann::json& skin, const std::string& what) {
            const auto joints = skin.find("joints");
            if (joints == skin.end() || !joints->is_array() || joints->empty())
                fail(file_, what + " has no joints; export it anew");
        });
    }

private:
    template <class Check>
    static void each(const nlohmann::json& text, const char* list, const char* kind, const Check& check) {
        const auto found = text.find(list);
        if (found == text.end() || !found->is_array())
            return;
        for (std::size_t i = 0; i < found->size(); ++i)
            if ((*found)[i].is_object())
                check((*found)[i], fmt::format("{} {}", kind, i));
    }
    void numbers(const nlohmann::json& object, const char* key, const std::string& what) const {
        const auto found = object.find(key);
        if (found != object.end() &&
            !(found->is_array() && std::all_of(found->begin(), found->end(),
                                               [](const nlohmann::json& x) { return x.is_number(); })))
            refuse(*found, key, what, "is no list of numbers");
    }
    void bytes(const nlohmann::json& object, const char* key, const std::string& what) const {
        const auto found = object.find(key);
        if (found != object.end() && !found->is_number_unsigned())
            refuse(*found, key, what, "is no number of bytes");
    }
    [[noreturn]] void refuse(const nlohmann::json& value, const char* key, const std::string& what,
                             std::string_view is) const {
        fail(file_, fmt::format(
                        "{} has {} {}, which {}; export it anew", what, key,
                        printable(value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)), is));
    }

    const nlohmann::json& text_;
    std::string_view file_;
};

/// What the text is asked for before anything else reads it.
void summarise(const nlohmann::json& text, Container& container) {
    const auto list = [](const nlohmann::json& object, const char* key) {
        const auto found = object.is_object() ? object.find(key) : object.end();
        return found != object.end() && found->is_array() ? *found : nlohmann::json::array();
    };
    if (text.contains("asset") && text["asset"].is_object() && text["asset"].contains("version") &&
        text["asset"]["version"].is_string())
        container.version = text["asset"]["version"].get<std::string>();
    if (const auto asset = text.find("asset"); asset != text.end() && asset->is_object())
        if (const auto least = asset->find("minVersion"); least != asset->end() && least->is_string())
            container.least_version = least->get<std::string>();
    for (const nlohmann::json& name : list(text, "extensionsRequired"))
        container.required.push_back(name.is_string() ? name.get<std::string>() : name.dump());
    for (const nlohmann::json& mesh : list(text, "meshes"))
        container.primitives += list(mesh, "primitives").size();
}

/// Bytes that base64 text stands for (RFC 4648, 4).
std::size_t decoded_size(std::string_view text) {
    while (text.ends_with('='))
        text.remove_suffix(1);
    return text.size() * 3 / 4;
}

/// Buffers may be longer than they state (glTF 2.0, 3.6.1), which the parser does not know.
void allow_longer_buffers(nlohmann::json& text, Container& container) {
    const auto found = text.find("buffers");
    if (found == text.end() || !found->is_array())
        return;
    constexpr std::string_view base64 = ";base64,";
    for (nlohmann::json& buffer : *found) {
        if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string() ||
            !buffer.contains("byteLength") || !buffer["byteLength"].is_number_unsigned())
            continue;
        const auto& uri = buffer["uri"].get_ref<const std::string&>();
        const auto stated = buffer["byteLength"].get<std::size_t>();
        if (!uri.starts_with("data:"))
            container.lengths.push_back(stated);
        else if (const std::size_t at = uri.find(base64); at != uri.npos)
            buffer["byteLength"] =
                std::max(stated, decoded_size(std::string_view(uri).substr(at + base64.size())));
    }
}

/// Takes cameras and extensions out of the text.
std::string stage_of(nlohmann::json& text) {
    using nlohmann::json;
    const auto move_member = [](json& from, const char* key, json& to) {
        const auto found = from.find(key);
        if (found == from.end())
            return false;
        to[key] = std::move(*found);
        from.erase(found);
        return true;
    };
    json stage = json::object();
    json& nodes = stage["nodes"] = json::array();
    bool any = false;
    if (const auto found = text.find("nodes"); found != text.end() && found->is_array())
        for (json& node : *found) {
            json& carried = nodes.emplace_back(json::object());
            if (node.is_object()) {
                any = move_member(node, "camera", carried) || any;
                any = move_member(node, "extensions", carried) || any;
            }
        }
    move_member(text, "cameras", stage);
    move_member(text, "extensions", stage);
    return any ? stage.dump(-1, ' ', false, json::error_handler_t::replace) : "";
}

/// Reads the text, and leaves out what is not needed.
void sift(std::string_view text, std::string_view file, Container& container) {
    using nlohmann::json;
    bool appearance = false, nodes = false; // whether the parser is inside such a list
    const auto keep = [file, &appearance, &nodes](int depth, json::parse_event_t event, json& parsed) {
        if (depth > deepest)
            fail(file, fmt::format("brackets more than {} deep; this is no glTF file", deepest));
        if (event != json::parse_event_t::key)
            return true;
        const auto& key = parsed.get_ref<const std::string&>();
        const auto is_in = [&](const auto& list) {
            return std::find(list.begin(), list.end(), key) != list.end();
        };
        if (depth == 1) {
            appearance = is_in(of_appearance);
            nodes = key == "nodes";
            return key == "scene" || key == "cameras" || key == "extensions" || appearance || is_in(needed);
        }
        return key != "extras" && (appearance || (nodes && depth == 3) || key != "extensions");
    };
    try {
        json sifted = json::parse(text, keep);
        if (!sifted.is_object())
            fail(file, "holds no JSON object; give a glTF file");
        TypeCheck(sifted, file).run();
        summarise(sifted, container);
        allow_longer_buffers(sifted, container);
        json apart = json::object();
        for (const std::string_view list : of_appearance)
            if (const auto found = sifted.find(list); found != sifted.end()) {
                apart[std::string(list)] = std::move(*found);
                sifted.erase(found);
            }
        container.stage = stage_of(sifted);
        container.json = sifted.dump(-1, ' ', false, json::error_handler_t::replace);
        container.appearance = apart.dump(-1, ' ', false, json::error_handler_t::replace);
    } catch (const json::parse_error& error) {
        const std::string_view read =
            text.substr(0, std::min(text.size(), std::max<std::size_t>(error.byte, 1) - 1));
        const std::size_t line_begin = read.rfind('\n') + 1; // 0 where there is none
        const std::string place = fmt::format("{}:{}", 1 + std::count(read.begin(), read.end(), '\n'),
                                              read.size() - line_begin + 1);
        if (container.is_binary)
            fail(file, fmt::format("its JSON is broken at {}; export it anew", place));
        throw UserError(
            fmt::format("{}:{}: is no glTF file, or broken; export it anew", printable(file, 1000), place));
    } catch (const json::exception& error) {
        fail(file, fmt::format("is no glTF file ({}); export it anew", printable(error.what(), 200)));
    }
}

} // namespace

Container open_container(std::string_view bytes, std::string_view file) {
    Container container;
    if (bytes.substr(0, magic.size()) != magic) {
        sift(bytes, file, container);
        return container;
    }
    if (bytes.size() < header_size + chunk_header_size)
        fail(file, "is cut short; export it anew");
    if (const std::uint32_t version = word_at(bytes, 4); version != 2)
        fail(file, fmt::format("binary glTF of version {}; export it as glTF 2.0", version));
    const std::size_t size = word_at(bytes, 8);
    if (size > bytes.size())
        fail(file, fmt::format("is cut short: {} of {} bytes; export it anew", bytes.size(), size));
    container.is_binary = true;
    std::string_view json;
    for (std::size_t at = header_size; at + chunk_header_size <= size;) {
        const std::size_t length = word_at(bytes, at), begin = at + chunk_header_size;
        const std::uint32_t type = word_at(bytes, at + 4);
        if (length > size - begin)
            fail(file, fmt::format("its chunk at byte {} is longer than the file; export it anew", at));
        if (at == header_size && type != json_chunk)
            fail(file, "its first chunk is no JSON; export it anew");
        if (type == json_chunk && json.empty())
            json = bytes.substr(begin, length);
        else if (type == binary_chunk && container.binary.empty())
            container.binary = bytes.substr(begin, length);
        at = begin + length;
    }
    sift(json, file, container);
    return container;
}

std::string to_glb(const Container& container) {
    std::string glb{magic};
    glb.reserve(container.json.size() + container.binary.size() + 64);
    append_word(glb, 2);
    append_word(glb, 0);
    append_chunk(glb, json_chunk, container.json, ' ');
    if (!container.binary.empty())
        append_chunk(glb, binary_chunk, container.binary, '\0');
    std::string size;
    append_word(size, glb.size());
    return glb.replace(8, 4, size);
}

} // namespace razor::gltf
