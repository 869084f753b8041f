#include "razor/scene/models/ply_reader.h"

#include "razor/scene/error.h"
#include "razor/scene/models/ply_body.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>
#include <tuple>

namespace razor {
namespace {

constexpr std::uint64_t max_count = std::numeric_limits<int>::max();
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> texcoord_names{
    {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}};

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// For each of so many things the first one with the same key.
template <class Key> std::vector<int> first_equal(std::size_t count, Key key) {
    std::vector<int> order(count), first(count);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    for (std::size_t i = 0; i < count; ++i) {
        const bool again = i > 0 && key(order[i - 1]) == key(order[i]);
        first[at(order[i])] = again ? first[at(order[i - 1])] : order[i];
    }
    return first;
}

/// Keeps those that are their own first, and lets `first` name them by their new numbers.
template <class Value> void keep_first(std::vector<Value>& values, std::vector<int>& first) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (at(first[i]) == i) {
            values[kept] = values[i];
            first[i] = static_cast<int>(kept++);
        } else {
            first[i] = first[at(first[i])]; // renumbered before: it comes first
        }
    }
    values.resize(kept);
}

class PlyReader {
public:
    PlyReader(std::string_view bytes, std::string_view file_name)
        : file_name_(file_name), header_(parse_ply_header(bytes, file_name)),
          body_(bytes, header_, file_name), vertices_(needed("vertex")), faces_(needed("face")) {
        mesh_.name = std::filesystem::path(file_name).stem().string();
    }

    Mesh read() {
        find_properties();
        for (const PlyElement& element : header_.elements) {
            if (element.properties.empty()) {
                continue; // takes no bytes, of whatever number
            }
            body_.begin(element);
            if (&element == &vertices_) {
                read_vertices();
            } else if (&element == &faces_) {
                read_faces();
            } else {
                for (std::uint64_t n = 0; n < element.count; ++n) {
                    body_.at(n);
                    for (const PlyProperty& property : element.properties) {
                        body_.skip(property);
                    }
                }
            }
        }
        body_.finish();
        if (texcoords_[0] != nullptr || vertices_.find("nx") != nullptr) {
            join();
        } else if (mesh_.face_sizes.empty()) {
            fail(0, "no faces; a model needs at least one");
        }
        return std::move(mesh_);
    }

private:
    [[noreturn]] void fail(std::int64_t line, std::string_view message) const {
        throw UserError(fmt::format("{}{}: {}", printable(file_name_, 1000),
                                    line > 0 ? fmt::format(":{}", line) : "", message));
    }

    const PlyElement& needed(std::string_view name) const {
        const PlyElement* const element = header_.find(name);
        if (element == nullptr) {
            fail(0, fmt::format("has no element '{}'; give a model of polygons", name));
        }
        if (element->count > max_count) {
            fail(element->line, fmt::format("more than {} elements '{}'; split the model", max_count, name));
        }
        return *element;
    }

    void find_properties() {
        constexpr std::array<std::string_view, 3> names{"x", "y", "z"};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            xyz_[axis] = vertices_.find(names[axis]);
            if (xyz_[axis] == nullptr || xyz_[axis]->count) {
                fail(vertices_.line,
                     fmt::format("vertices have no number '{}'; export them with x, y and z", names[axis]));
            }
        }
        for (const auto& [u, v] : texcoord_names) {
            const PlyProperty *const found_u = vertices_.find(u), *const found_v = vertices_.find(v);
            if (found_u != nullptr && found_v != nullptr && !found_u->count && !found_v->count) {
                texcoords_ = {found_u, found_v};
                break;
            }
        }
        corners_ = faces_.find("vertex_indices");
        if (corners_ == nullptr) {
            corners_ = faces_.find("vertex_index");
        }
        if (corners_ == nullptr || !corners_->count || is_real(corners_->type)) {
            fail(faces_.line,
                 "faces have no list of whole numbers 'vertex_indices' or 'vertex_index'; export "
                 "them with one");
        }
    }

    void read_vertices() {
        const auto count = static_cast<std::size_t>(vertices_.count);
        mesh_.points.resize(count);
        mesh_.texcoords.resize(texcoords_[0] == nullptr ? 0 : count);
        for (std::size_t n = 0; n < count; ++n) {
            body_.at(n);
            for (const PlyProperty& property : vertices_.properties) {
                if (const auto* const axis = std::find(xyz_.begin(), xyz_.end(), &property);
                    axis != xyz_.end()) {
                    const double value = body_.number(property.type);
                    if (!std::isfinite(value)) {
                        body_.fail(fmt::format("{} is no finite number; mend it", property.name));
                    }
                    mesh_.points[n][static_cast<int>(axis - xyz_.begin())] = value;
                } else if (&property == texcoords_[0] || &property == texcoords_[1]) {
                    const auto value = static_cast<float>(body_.number(property.type));
                    if (!std::isfinite(value)) {
                        body_.fail("texture coordinate beyond single precision; mend it");
                    }
                    mesh_.texcoords[n][&property == texcoords_[0] ? 0 : 1] = value;
                } else {
                    body_.skip(property);
                }
            }
        }
    }

    void read_faces() {
        mesh_.face_sizes.reserve(static_cast<std::size_t>(faces_.count));
        for (std::uint64_t n = 0; n < faces_.count; ++n) {
            body_.at(n);
            for (const PlyProperty& property : faces_.properties) {
                if (&property == corners_) {
                    read_corners();
                } else {
                    body_.skip(property);
                }
            }
        }
    }

    void read_corners() {
        const std::size_t count = body_.length(*corners_);
        if (count < 3) {
            body_.fail(
                fmt::format("face with {} corner{}; a face needs 3 or more", count, count == 1 ? "" : "s"));
        }
        if (count > max_count - mesh_.face_vertices.size()) {
            body_.fail(fmt::format("more than {} face corners; split the model", max_count));
        }
        const std::size_t first = mesh_.face_vertices.size();
        for (std::size_t c = 0; c < count; ++c) {
            const std::int64_t index = body_.whole(corners_->type);
            if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_.count) {
                body_.fail(fmt::format("face names vertex {}, but the file has {}, from 0; mend the index",
                                       index, vertices_.count));
            }
            mesh_.face_vertices.push_back(static_cast<int>(index));
        }
        int before = mesh_.face_vertices.back();
        for (std::size_t c = first; c < mesh_.face_vertices.size(); ++c) {
            if (mesh_.face_vertices[c] == before) {
                body_.fail(fmt::format("face names vertex {} twice in a row; name each corner once", before));
            }
            before = mesh_.face_vertices[c];
        }
        mesh_.face_sizes.push_back(static_cast<int>(count));
    }

    /// Vertices at one place become one point; those that have one texture coordinate there, too, one of
    /// these.
    void join() {
        std::vector<int> point = first_equal(mesh_.points.size(), [this](int i) {
            const glm::dvec3& p = mesh_.points[at(i)];
            return std::tuple(p.x, p.y, p.z);
        });
        std::vector<int> texcoord;
        const bool textured = !mesh_.texcoords.empty();
        if (textured) {
            texcoord = first_equal(mesh_.points.size(), [&](int i) {
                const glm::vec2& uv = mesh_.texcoords[at(i)];
                return std::tuple(point[at(i)], uv.x, uv.y);
            });
            keep_first(mesh_.texcoords, texcoord);
        }
        keep_first(mesh_.points, point);
        std::vector<int> sizes, corners, corner_texcoords;
        std::size_t begin = 0;
        for (const int size : mesh_.face_sizes) {
            const std::size_t end = begin + at(size), kept = corners.size();
            int before = point[at(mesh_.face_vertices[end - 1])];
            for (; begin < end; ++begin) {
                const std::size_t vertex = at(mesh_.face_vertices[begin]);
                if (point[vertex] != before) {
                    before = point[vertex];
                    corners.push_back(before);
                    if (textured) {
                        corner_texcoords.push_back(texcoord[vertex]);
                    }
                }
            }
            if (corners.size() < kept + 3) {
                corners.resize(kept);
                corner_texcoords.resize(textured ? kept : 0);
            } else {
                sizes.push_back(static_cast<int>(corners.size() - kept));
            }
        }
        if (sizes.empty()) {
            fail(0, "no faces that have an area; a model needs at least one");
        }
        mesh_.face_sizes = std::move(sizes);
        mesh_.face_vertices = std::move(corners);
        mesh_.face_texcoords = std::move(corner_texcoords);
    }

    std::string_view file_name_;
    PlyHeader header_;
    PlyBody body_;
    const PlyElement &vertices_, &faces_;
    std::array<const PlyProperty*, 3> xyz_{};
    std::array<const PlyProperty*, 2> texcoords_{}; // null: there are none
    const PlyProperty* corners_ = nullptr;
    Mesh mesh_;
};

} // namespace

Mesh read_ply(const std::filesystem::path& path) {
    return parse_ply(read_text_file(path, "a PLY file"), path.string());
}

Mesh parse_ply(std::string_view bytes, std::string_view file_name) {
    try {
        return PlyReader(bytes, file_name).read();
    } catch (const std::bad_alloc&) {
        throw UserError(fmt::format("{}: the model does not fit in memory; give a smaller one",
                                    printable(file_name, 1000)));
    }
}

} // namespace razor
