#include "razor/scene/models/md3_reader.h"

#include "razor/scene/error.h"
#include "razor/scene/models/md3_cage.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <new>
#include <numbers>

namespace razor {
namespace {

constexpr std::string_view magic = "IDP3"; // of the file and of each surface
constexpr std::int32_t read_version = 15;
constexpr std::uint64_t max_count = std::numeric_limits<int>::max();
constexpr std::string_view damaged = "the file is cut off or damaged, so export or copy it again";

/// Where the fields of the file's header lie, in bytes from its beginning.
namespace header {
constexpr std::uint64_t version = 4, frames = 76, tags = 80, surfaces = 84, tags_at = 96, surfaces_at = 100,
                        end = 104, bytes = 108;
} // namespace header

/// The same of a surface's header. Offsets in it count from the surface's beginning.
namespace surface {
constexpr std::uint64_t name = 4, name_bytes = 64, frames = 72, shaders = 76, vertices = 80, triangles = 84,
                        triangles_at = 88, shaders_at = 92, texcoords_at = 96, points_at = 100, end = 104,
                        bytes = 108;
} // namespace surface

/// The same of a tag.
namespace tag {
constexpr std::uint64_t name_bytes = 64, origin = 64, axes = 76, bytes = 112;
} // namespace tag

constexpr std::uint64_t triangle_bytes = 12; // 3 vertex indices
constexpr std::uint64_t shader_bytes = 68;   // a name of 64; an index that the game fills in
constexpr std::uint64_t texcoord_bytes = 8;  // s, t: float
constexpr std::uint64_t point_bytes = 8;     // x, y, z: 16 bits; a normal: two angles of 8 bits

class Md3Reader {
public:
    Md3Reader(std::string_view bytes, std::string_view file_name, double crease_degrees)
        : bytes_(bytes), file_name_(printable(file_name, 1000)),
          name_(std::filesystem::path(file_name).stem().string()), crease_degrees_(crease_degrees) {}

    Md3Model read() {
        read_header();
        std::uint64_t at = surfaces_at_;
        for (std::uint64_t s = 0; s < surface_count_; ++s) {
            at += read_surface(s, at);
        }
        Md3Model model = join(all_, crease_degrees_);
        if (model.cage.face_sizes.empty()) {
            fail(fmt::format(
                "none of its {} triangles has three distinct corners; give a model with a surface",
                all_.corners.size() / 3));
        }
        model.cage.name = name_;
        model.surfaces = std::move(surfaces_);
        model.tags = read_tags();
        return model;
    }

private:
    /// The surface being read, for messages.
    struct Surface {
        std::uint64_t at = 0, bytes = 0;
        std::string label;
    };

    void read_header() {
        if (!bytes_.starts_with(magic)) {
            fail(fmt::format("begins with '{}', not with '{}'; give a Quake III MD3 model",
                             printable(bytes_.substr(0, magic.size())), magic));
        }
        if (bytes_.size() < header::bytes) {
            fail(fmt::format("has {} bytes, but the header alone takes {}; {}", bytes_.size(), header::bytes,
                             damaged));
        }
        if (const std::int32_t version = integer(header::version); version != read_version) {
            fail(fmt::format("is of MD3 version {}; export it as version {}", version, read_version));
        }
        all_.frame_count = header_count("frames", header::frames);
        surface_count_ = header_count("surfaces", header::surfaces);
        if (const std::int32_t end = integer(header::end); end < 0 || as_size(end) > bytes_.size()) {
            fail(fmt::format("should end at byte {}, but has {} bytes; {}", end, bytes_.size(), damaged));
        }
        const std::int32_t at = integer(header::surfaces_at);
        if (at < 0) {
            fail(fmt::format("surfaces begin at byte {}; {}", at, damaged));
        }
        surfaces_at_ = as_size(at);
    }

    /// Frames or surfaces.
    std::uint64_t header_count(std::string_view what, std::uint64_t field) const {
        const std::int32_t count = integer(field);
        if (count < 0) {
            fail(fmt::format("states {} {} (at byte {}); {}", count, what, field, damaged));
        }
        if (count == 0) {
            fail(fmt::format("has no {}; export it with one at least", what));
        }
        return as_size(count);
    }

    /// All tags of frame 0, then all of frame 1 ...
    std::vector<TagFrames> read_tags() const {
        const std::int32_t count = integer(header::tags), at = integer(header::tags_at);
        if (count < 0 || at < 0) {
            fail(fmt::format("states {} tags from byte {} on (at bytes {} and {}); {}", count, at,
                             header::tags, header::tags_at, damaged));
        }
        if (count == 0) {
            return {};
        }
        const std::uint64_t begin = as_size(at), frame_bytes = as_size(count) * tag::bytes;
        if (begin > bytes_.size() || all_.frame_count > (bytes_.size() - begin) / frame_bytes) {
            fail(fmt::format("{} tags of {} frames from byte {} on do not fit into its {} bytes; {}", count,
                             all_.frame_count, begin, bytes_.size(), damaged));
        }
        std::vector<TagFrames> tags(as_size(count));
        for (std::uint64_t t = 0; t < tags.size(); ++t) {
            tags[t].name = text(begin + t * tag::bytes, tag::name_bytes);
            for (std::uint64_t f = 0; f < all_.frame_count; ++f) {
                tags[t].frames.push_back(read_tag(begin + f * frame_bytes + t * tag::bytes, f, tags[t].name));
            }
        }
        return tags;
    }

    /// Stored are the origin and where the three axes of what is attached go.
    Affine read_tag(std::uint64_t at, std::uint64_t frame, const std::string& name) const {
        if (const std::string found = text(at, tag::name_bytes); found != name) {
            fail(fmt::format(
                "the tag '{}' is called '{}' in frame {} (at byte {}); export all frames with the "
                "same tags",
                printable(name, 100), printable(found, 100), frame, at));
        }
        const auto vector = [&](std::uint64_t from) {
            return glm::dvec3(real(from), real(from + 4), real(from + 8));
        };
        Affine place{glm::dmat3(0), vector(at + tag::origin)};
        for (int axis = 0; axis < 3; ++axis) {
            place.linear[axis] = vector(at + tag::axes + 12 * static_cast<std::uint64_t>(axis));
        }
        return place;
    }

    /// Adds the vertices and triangles of surface `number` at byte `at`; how many bytes it takes.
    std::uint64_t read_surface(std::uint64_t number, std::uint64_t at) {
        Surface s{at, 0, fmt::format("surface {} of {} at byte {}", number + 1, surface_count_, at)};
        if (at > bytes_.size() || bytes_.size() - at < surface::bytes) {
            fail(fmt::format("{}: its header does not fit into the file's {} bytes; {}", s.label,
                             bytes_.size(), damaged));
        }
        if (const std::string_view found = bytes_.substr(at, magic.size()); found != magic) {
            fail(fmt::format("{}: begins with '{}', not with '{}'; {}", s.label, printable(found), magic,
                             damaged));
        }
        s.label =
            fmt::format("surface {} of {} ('{}', at byte {})", number + 1, surface_count_,
                        printable(text(at + surface::name, surface::name_bytes), surface::name_bytes), at);
        surfaces_.push_back({text(at + surface::name, surface::name_bytes)});
        s.bytes = field(s, "size", surface::end);
        if (s.bytes < surface::bytes || s.bytes > bytes_.size() - at) {
            fail(fmt::format("{}: states a size of {} bytes, where {} to {} are possible; {}", s.label,
                             s.bytes, surface::bytes, bytes_.size() - at, damaged));
        }
        if (const std::uint64_t count = field(s, "frames", surface::frames); count != all_.frame_count) {
            fail(fmt::format("{}: has {} frames, but the model {}; export all surfaces with the same frames",
                             s.label, count, all_.frame_count));
        }
        const std::uint64_t vertices = field(s, "vertices", surface::vertices);
        const std::uint64_t triangles = field(s, "triangles", surface::triangles);
        const std::uint64_t triangles_at =
            table(s, "triangles", surface::triangles_at, triangles, triangle_bytes);
        const std::uint64_t texcoords_at =
            table(s, "texture coordinates", surface::texcoords_at, vertices, texcoord_bytes);
        // No overflow: both are below 2^31.
        const std::uint64_t points_at =
            table(s, "points", surface::points_at, all_.frame_count * vertices, point_bytes);
        if (all_.texcoords.size() + vertices > max_count || all_.corners.size() + 3 * triangles > max_count) {
            fail(fmt::format("has more than {} vertices or corners; split the model", max_count));
        }
        read_triangles(s, triangles_at, triangles, vertices);
        read_texcoords(s, texcoords_at, vertices);
        read_points(points_at, vertices);
        read_shaders(s);
        return s.bytes;
    }

    /// A count, size or offset of the surface's header.
    std::uint64_t field(const Surface& s, std::string_view what, std::uint64_t offset) const {
        const std::int32_t value = integer(s.at + offset);
        if (value < 0) {
            fail(fmt::format("{}: states {} for its {} (at byte {}); {}", s.label, value, what, s.at + offset,
                             damaged));
        }
        return as_size(value);
    }

    /// Where in the file a table of the surface begins. It lies within the surface: tables that many surfaces
    /// share would let a small file fill the memory.
    std::uint64_t table(const Surface& s, std::string_view what, std::uint64_t offset, std::uint64_t count,
                        std::uint64_t record_bytes) const {
        const std::uint64_t begin = field(s, what, offset);
        if (begin > s.bytes || count > (s.bytes - begin) / record_bytes) {
            fail(fmt::format("{}: {} {} of {} bytes from its byte {} on do not fit into its {} bytes; {}",
                             s.label, count, what, record_bytes, begin, s.bytes, damaged));
        }
        return s.at + begin;
    }

    void read_triangles(const Surface& s, std::uint64_t at, std::uint64_t count, std::uint64_t vertices) {
        const auto first = static_cast<int>(all_.texcoords.size());
        for (std::uint64_t t = 0; t < count; ++t, at += triangle_bytes) {
            std::array<int, 3> corners{};
            for (std::uint64_t c = 0; c < 3; ++c) {
                const std::int32_t vertex = integer(at + 4 * c);
                if (vertex < 0 || as_size(vertex) >= vertices) {
                    fail(fmt::format("{}: triangle {} (counted from 0, at byte {}) names vertex {}, but the "
                                     "surface has {}; mend the index",
                                     s.label, t, at, vertex, vertices));
                }
                corners[c] = first + vertex;
            }
            all_.corners.insert(all_.corners.end(),
                                {corners[0], corners[2], corners[1]}); // counter-clockwise
            all_.surfaces.push_back(static_cast<int>(surfaces_.size()) - 1);
        }
    }

    void read_shaders(const Surface& s) {
        const std::uint64_t count = field(s, "shaders", surface::shaders);
        if (count == 0) {
            return; // wherever they begin
        }
        const std::uint64_t begin = table(s, "shaders", surface::shaders_at, count, shader_bytes);
        for (std::uint64_t i = 0; i < count; ++i) {
            surfaces_.back().shaders.push_back(text(begin + i * shader_bytes, surface::name_bytes));
        }
    }

    void read_texcoords(const Surface& s, std::uint64_t at, std::uint64_t count) {
        for (std::uint64_t v = 0; v < count; ++v, at += texcoord_bytes) {
            const auto u = std::bit_cast<float>(word(at));
            const auto t = std::bit_cast<float>(word(at + 4));
            if (!std::isfinite(u) || !std::isfinite(t)) {
                fail(fmt::format("{}: texture coordinate of vertex {} (counted from 0, at byte {}) is not "
                                 "finite; mend it",
                                 s.label, v, at));
            }
            all_.texcoords.emplace_back(u, 1 - t);
        }
    }

    /// The file holds frame after frame; here all frames of a vertex follow each other.
    void read_points(std::uint64_t at, std::uint64_t count) {
        std::size_t to = all_.steps.size();
        all_.steps.resize(to + 3 * count * all_.frame_count);
        for (std::uint64_t v = 0; v < count; ++v) {
            if (crease_degrees_ < no_crease_angle) {
                all_.normals.push_back(normal(at + point_bytes * v + 6));
            }
            for (std::uint64_t f = 0; f < all_.frame_count; ++f) {
                const std::uint64_t from = at + point_bytes * (f * count + v);
                for (std::uint64_t axis = 0; axis < 3; ++axis) {
                    all_.steps[to++] =
                        static_cast<std::int16_t>(byte(from + 2 * axis) | byte(from + 2 * axis + 1) << 8);
                }
            }
        }
    }

    /// Of frame 0, as two angles: from z, and about it from x; 255 steps a turn.
    glm::vec3 normal(std::uint64_t at) const {
        constexpr float step = 2 * std::numbers::pi_v<float> / 255;
        const float from_z = step * static_cast<float>(byte(at)),
                    about = step * static_cast<float>(byte(at + 1));
        return {std::cos(about) * std::sin(from_z), std::sin(about) * std::sin(from_z), std::cos(from_z)};
    }

    /// Of a number that is not negative.
    static std::size_t as_size(std::int32_t number) { return static_cast<std::size_t>(number); }

    // Little endian, wherever it lies. The caller has checked that it lies in the file.
    std::uint32_t byte(std::uint64_t at) const { return static_cast<unsigned char>(bytes_[at]); }
    std::uint32_t word(std::uint64_t at) const {
        return byte(at) | byte(at + 1) << 8 | byte(at + 2) << 16 | byte(at + 3) << 24;
    }
    std::int32_t integer(std::uint64_t at) const { return static_cast<std::int32_t>(word(at)); }
    double real(std::uint64_t at) const { return std::bit_cast<float>(word(at)); }
    /// Up to a zero byte, or all.
    std::string text(std::uint64_t at, std::uint64_t most_bytes) const {
        const std::string_view field = bytes_.substr(at, most_bytes);
        return std::string(field.substr(0, field.find('\0')));
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw UserError(fmt::format("{}: {}", file_name_, what));
    }

    std::string_view bytes_;
    std::string file_name_, name_;
    std::vector<Md3Surface> surfaces_;
    double crease_degrees_;
    std::uint64_t surface_count_ = 0, surfaces_at_ = 0;
    Md3Triangles all_;
};

} // namespace

Md3Model read_md3(const std::filesystem::path& path, double crease_degrees) {
    return parse_md3(read_text_file(path, "an MD3 model"), path.string(), crease_degrees);
}

Md3Model parse_md3(std::string_view bytes, std::string_view file_name, double crease_degrees) {
    try {
        return Md3Reader(bytes, file_name, crease_degrees).read();
    } catch (const std::bad_alloc&) {
        throw UserError(fmt::format("{}: the model does not fit in memory; give a smaller one",
                                    printable(file_name, 1000)));
    }
}

} // namespace razor
