// Small glTF files for tests, written by hand: JSON with one buffer.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace razor {

class GltfWriter {
public:
    using Json = nlohmann::json;

    Json json{{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    std::string bytes; // of the buffer

    template <class Number> int view(const std::vector<Number>& numbers, std::size_t stride = 0) {
        const std::size_t offset = bytes.size();
        bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
        Json view{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", numbers.size() * sizeof(Number)}};
        if (stride != 0)
            view["byteStride"] = stride;
        json["bufferViews"].push_back(view);
        bytes.append((4 - bytes.size() % 4) % 4, '\0');
        return last("bufferViews");
    }
    /// Its number. `width`: components an element.
    template <class Number>
    int accessor(const std::vector<Number>& numbers, std::size_t width, bool normalized = false) {
        constexpr const char* types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
        const int component = std::is_same_v<Number, float>           ? 5126
                              : std::is_same_v<Number, std::int8_t>   ? 5120
                              : std::is_same_v<Number, std::uint8_t>  ? 5121
                              : std::is_same_v<Number, std::int16_t>  ? 5122
                              : std::is_same_v<Number, std::uint16_t> ? 5123
                                                                      : 5125;
        json["accessors"].push_back({{"bufferView", view(numbers)},
                                     {"componentType", component},
                                     {"count", numbers.size() / width},
                                     {"normalized", normalized},
                                     {"type", width == 16 ? "MAT4" : types[width - 1]}});
        return last("accessors");
    }
    int floats(const std::vector<float>& numbers, std::size_t width) { return accessor(numbers, width); }

    int add(const char* list, const Json& entry) {
        json[list].push_back(entry);
        return last(list);
    }
    /// A channel of the first animation.
    void channel(int node, const char* path, const std::vector<float>& times,
                 const std::vector<float>& values, std::size_t width, const char* interpolation = "LINEAR") {
        if (!json.contains("animations"))
            json["animations"] = {{{"channels", Json::array()}, {"samplers", Json::array()}}};
        const int input = floats(times, 1), output = floats(values, width);
        Json& animation = json["animations"][0];
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
        animation["samplers"].push_back(
            {{"input", input}, {"output", output}, {"interpolation", interpolation}});
    }

    std::string text() const {
        Json all = json;
        all["buffers"] = {
            {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
        return all.dump();
    }
    std::string text_with_buffer_file(const std::string& uri) const {
        Json all = json;
        all["buffers"] = {{{"byteLength", bytes.size()}, {"uri", uri}}};
        return all.dump();
    }
    std::string glb() const {
        Json all = json;
        all["buffers"] = {{{"byteLength", bytes.size()}}};
        std::string text = all.dump(), data = bytes;
        text.append((4 - text.size() % 4) % 4, ' ');
        data.append((4 - data.size() % 4) % 4, '\0');
        return "glTF" + word(2) + word(12 + 8 + text.size() + 8 + data.size()) + word(text.size()) + "JSON" +
               text + word(data.size()) + std::string("BIN\0", 4) + data;
    }

private:
    int last(const char* list) const { return static_cast<int>(json[list].size()) - 1; }
    static std::string word(std::size_t n) {
        std::string s;
        for (int i = 0; i < 4; ++i)
            s += static_cast<char>(n >> (8 * i) & 255);
        return s;
    }
    static std::string base64(const std::string& data) {
        constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string s;
        for (std::size_t i = 0; i < data.size(); i += 3) {
            unsigned group = 0;
            for (std::size_t k = 0; k < 3; ++k)
                group = group << 8 | (i + k < data.size() ? static_cast<unsigned char>(data[i + k]) : 0);
            for (std::size_t k = 0; k < 4; ++k)
                s += i + k > data.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
        }
        return s;
    }
};

/// A triangle (0 0 0), (1 0 0), (0 1 0), drawn by node 0.
inline GltfWriter triangle() {
    GltfWriter w;
    const int points = w.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    w.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", points}}}}}}});
    w.add("nodes", {{"mesh", 0}});
    return w;
}

} // namespace razor
