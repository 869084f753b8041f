// MD3 bytes made from plain lists, after the published description of the format, for tests of its reader.
// Every count and offset can be overwritten afterwards.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace razor {

struct Md3SurfaceData {
    std::string name;
    std::vector<std::array<int, 3>> triangles;                // clockwise seen from outside
    std::vector<std::array<float, 2>> texcoords;              // s, t of each vertex
    std::vector<std::vector<std::array<int, 3>>> frame_steps; // of each frame, of each vertex: 1/64 unit
    /// As it is stored, of each vertex in frame 0; empty, and in other frames: something that differs from
    /// vertex to vertex, on which nothing may depend.
    std::vector<int> normals{};
    std::vector<std::string> shaders{"models/skin.tga"};
};

inline void put(std::string& bytes, std::size_t at, std::int32_t number) {
    for (std::size_t i = 0; i < 4; ++i) {
        bytes.at(at + i) = static_cast<char>(static_cast<std::uint32_t>(number) >> (8 * i) & 0xFFU);
    }
}

inline void append(std::string& bytes, std::int32_t number) {
    bytes.append(4, '\0');
    put(bytes, bytes.size() - 4, number);
}

inline std::string padded(std::string text, std::size_t length) {
    text.resize(length, '\0');
    return text;
}

/// The tables in the usual order: triangles, shaders, texture coordinates, points.
inline std::string write_surface(const Md3SurfaceData& data) {
    std::string triangles, shaders, texcoords, points;
    for (const std::string& shader : data.shaders) {
        shaders += padded(padded(shader, 64), 68);
    }
    for (const auto& triangle : data.triangles) {
        for (const int vertex : triangle) {
            append(triangles, vertex);
        }
    }
    for (const auto& texcoord : data.texcoords) {
        append(texcoords, std::bit_cast<std::int32_t>(texcoord[0]));
        append(texcoords, std::bit_cast<std::int32_t>(texcoord[1]));
    }
    for (const auto& frame : data.frame_steps) {
        for (const auto& p : frame) {
            const std::size_t number = points.size() / 8;
            const auto normal = static_cast<std::uint32_t>(number < data.normals.size() ? data.normals[number]
                                                                                        : int(points.size()));
            append(points, static_cast<std::int32_t>((static_cast<std::uint32_t>(p[0]) & 0xFFFFU) |
                                                     static_cast<std::uint32_t>(p[1]) << 16U));
            append(points,
                   static_cast<std::int32_t>((static_cast<std::uint32_t>(p[2]) & 0xFFFFU) | normal << 16U));
        }
    }
    std::string bytes = "IDP3";
    bytes += padded(data.name, 64);
    append(bytes, 0); // flags
    append(bytes, static_cast<std::int32_t>(data.frame_steps.size()));
    append(bytes, static_cast<std::int32_t>(data.shaders.size()));
    append(bytes, static_cast<std::int32_t>(data.texcoords.size()));
    append(bytes, static_cast<std::int32_t>(data.triangles.size()));
    std::size_t end = 108;
    for (const std::string* const table : {&triangles, &shaders, &texcoords, &points}) {
        append(bytes, static_cast<std::int32_t>(end));
        end += table->size();
    }
    append(bytes, static_cast<std::int32_t>(end));
    return bytes + triangles + shaders + texcoords + points;
}

/// A tag in one frame.
struct Md3TagData {
    std::array<float, 3> origin{};
    std::array<float, 9> axes{1, 0, 0, 0, 1, 0, 0, 0, 1}; // where x goes, y, z
};

struct Md3TagFrames {
    std::string name;
    std::vector<Md3TagData> frames;
};

/// Of all frames, one frame after the other.
inline std::string write_tags(const std::vector<Md3TagFrames>& tags, std::size_t frame_count) {
    std::string bytes;
    for (std::size_t f = 0; f < frame_count; ++f) {
        for (const Md3TagFrames& tag : tags) {
            bytes += padded(tag.name, 64);
            for (const float x : tag.frames.at(f).origin) {
                append(bytes, std::bit_cast<std::int32_t>(x));
            }
            for (const float x : tag.frames.at(f).axes) {
                append(bytes, std::bit_cast<std::int32_t>(x));
            }
        }
    }
    return bytes;
}

/// With frame boxes of zeros, and these tags; without any with one of no use.
inline std::string write_md3(const std::vector<Md3SurfaceData>& surfaces, std::size_t frame_count,
                             const std::vector<Md3TagFrames>& tag_frames = {}) {
    const std::string frames(56 * frame_count, '\0');
    const std::string tags =
        tag_frames.empty() ? std::string(112 * frame_count, '\x55') : write_tags(tag_frames, frame_count);
    std::string bytes = "IDP3";
    append(bytes, 15);
    bytes += padded("models/test.md3", 64);
    append(bytes, 0); // flags
    append(bytes, static_cast<std::int32_t>(frame_count));
    append(bytes, tag_frames.empty() ? 1 : static_cast<std::int32_t>(tag_frames.size()));
    append(bytes, static_cast<std::int32_t>(surfaces.size()));
    append(bytes, 0); // skins
    append(bytes, 108);
    append(bytes, static_cast<std::int32_t>(108 + frames.size()));
    append(bytes, static_cast<std::int32_t>(108 + frames.size() + tags.size()));
    append(bytes, 0);
    bytes += frames + tags;
    for (const Md3SurfaceData& surface : surfaces) {
        bytes += write_surface(surface);
    }
    put(bytes, 104, static_cast<std::int32_t>(bytes.size()));
    return bytes;
}

/// A quad and two triangles as two surfaces of two frames, with all that happens to vertices. 4 and 5 of
/// `left` lie where 0 and 2 do, 4 with another texture coordinate; its last triangle has an edge of no
/// length, 3 to 6. 0 of `right` lies where 2 of `left` does, with the same texture coordinate, and 1 where 1
/// does, with another; 2 meets 3 of `left` in frame 0 alone; 4 is in no triangle.
inline std::vector<Md3SurfaceData> two_surfaces() {
    Md3SurfaceData left{"left", {{0, 2, 1}, {4, 3, 5}, {3, 6, 0}}, {}, {}};
    left.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0.5F, 0.75F}, {1, 0}, {0.25F, 0.25F}};
    left.frame_steps = {{{0, 0, 0}, {64, 0, 0}, {64, 64, 0}, {0, 64, 0}, {0, 0, 0}, {64, 64, 0}, {0, 64, 0}},
                        {{0, 0, 1}, {64, 0, 2}, {64, 64, 3}, {0, 64, 4}, {0, 0, 1}, {64, 64, 3}, {0, 64, 4}}};
    Md3SurfaceData right{"right", {{1, 0, 3}, {1, 3, 2}}, {}, {}};
    right.texcoords = {{1, 0}, {0.125F, 1}, {0, 0}, {-2, 0.5F}, {9, 9}};
    right.frame_steps = {{{64, 64, 0}, {64, 0, 0}, {0, 64, 0}, {-32768, 32767, -1}, {7, 7, 7}},
                         {{64, 64, 3}, {64, 0, 2}, {0, 64, 5}, {128, 256, -512}, {7, 7, 7}}};
    return {std::move(left), std::move(right)};
}

} // namespace razor
