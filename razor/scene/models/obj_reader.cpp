#include "razor/scene/models/obj_reader.h"

#include "razor/scene/error.h"
#include "razor/scene/models/obj_cursor.h"
#include "razor/scene/models/obj_tags.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <new>
#include <unordered_map>

namespace razor {
namespace {

constexpr std::int64_t max_obj_count = std::numeric_limits<int>::max();
constexpr int no_texcoord = -1, no_material = -1;

/// Statements without effect on one cage's surface.
constexpr std::array<std::string_view, 16> passed_over{
    "vn", "vp",     "o",   "g",     "s",          "mg",        "usemap",   "l",
    "p",  "maplib", "lod", "bevel", "shadow_obj", "trace_obj", "c_interp", "d_interp",
};
constexpr std::array<std::string_view, 23> free_form{
    "cstype", "deg", "bmat", "step", "curv",  "curv2", "surf", "parm", "trim", "hole", "scrv", "sp",
    "end",    "con", "call", "csh",  "ctech", "stech", "bsp",  "bzp",  "cdc",  "cdp",  "res",
};

class ObjReader {
public:
    ObjReader(std::string_view text, std::string_view file_name, ObjMaterialNames* materials)
        : cursor_(text, file_name), file_name_(file_name), materials_(materials) {
        mesh_.name = std::filesystem::path(file_name).stem().string();
        const std::size_t guess = text.size() / 100;
        mesh_.points.reserve(guess);
        mesh_.texcoords.reserve(guess);
        mesh_.face_sizes.reserve(guess);
        mesh_.face_vertices.reserve(4 * guess);
        face_lines_.reserve(guess);
    }

    Mesh read() {
        while (!cursor_.at_end()) {
            if (const std::string_view keyword = cursor_.word(); !keyword.empty()) {
                read_statement(keyword);
            }
            cursor_.next_statement();
        }
        finish_faces();
        tags_.finish(cursor_, mesh_);
        return std::move(mesh_);
    }

private:
    void read_statement(std::string_view keyword) {
        const auto is_keyword = [&](std::string_view known) { return keyword == known; };
        if (keyword == "v") {
            read_point();
        } else if (keyword == "f" || keyword == "fo") { // fo: the same, in old files
            read_face();
        } else if (keyword == "vt") {
            read_texcoord();
        } else if (keyword == "usemtl") {
            use_material();
        } else if (keyword == "mtllib") {
            if (materials_ != nullptr) {
                materials_->libraries.emplace_back(cursor_.rest());
            }
        } else if (keyword == "t") {
            tags_.read(cursor_, mesh_);
        } else if (std::any_of(free_form.begin(), free_form.end(), is_keyword)) {
            cursor_.fail(fmt::format("'{}' belongs to free-form geometry, which is not read; export polygons",
                                     keyword));
        } else if (std::none_of(passed_over.begin(), passed_over.end(), is_keyword)) {
            cursor_.fail(fmt::format("'{}' is not an OBJ statement; remove the line or give an OBJ file",
                                     printable(keyword)));
        }
    }

    void use_material() {
        if (materials_ == nullptr) {
            return;
        }
        const auto [known, is_new] = material_numbers_.try_emplace(
            std::string(cursor_.rest()), static_cast<int>(materials_->names.size()));
        if (is_new) {
            materials_->names.push_back(known->first);
        }
        material_ = known->second;
        mesh_.face_materials.resize(mesh_.face_sizes.size(), no_material);
    }

    void read_point() {
        const double x = cursor_.number("x of v");
        const double y = cursor_.number("y of v");
        const double z = cursor_.number("z of v");
        while (!cursor_.at_statement_end()) {
            cursor_.number("weight or colour of v");
        }
        check_count(mesh_.points.size(), "points");
        mesh_.points.emplace_back(x, y, z);
    }

    void read_texcoord() {
        const auto u = static_cast<float>(cursor_.number("u of vt"));
        const auto v = cursor_.at_statement_end() ? 0.0F : static_cast<float>(cursor_.number("v of vt"));
        while (!cursor_.at_statement_end()) {
            cursor_.number("w of vt");
        }
        if (!std::isfinite(u) || !std::isfinite(v)) {
            cursor_.fail("texture coordinate beyond single precision; mend it");
        }
        check_count(mesh_.texcoords.size(), "texture coordinates");
        mesh_.texcoords.emplace_back(u, v);
    }

    void read_face() {
        const std::size_t first = mesh_.face_vertices.size();
        const std::int64_t line = cursor_.line();
        for (std::string_view corner = cursor_.word(); !corner.empty(); corner = cursor_.word()) {
            check_count(mesh_.face_vertices.size(), "face corners");
            read_corner(corner);
        }
        const std::size_t count = mesh_.face_vertices.size() - first;
        if (count < 3) {
            cursor_.fail_at(line, fmt::format("face with {} corner{}; a face needs 3 or more", count,
                                              count == 1 ? "" : "s"));
        }
        const auto* const texcoords = mesh_.face_texcoords.data() + first;
        const bool textured = texcoords[0] != no_texcoord;
        if (std::any_of(texcoords, texcoords + count,
                        [&](int t) { return (t != no_texcoord) != textured; })) {
            cursor_.fail_at(line, "only some corners of the face name a texture coordinate; name one at all "
                                  "corners or at none");
        }
        any_textured_ = any_textured_ || textured;
        any_untextured_ = any_untextured_ || !textured;
        check_distinct(first, line);
        mesh_.face_sizes.push_back(static_cast<int>(count));
        face_lines_.push_back(line);
        if (material_ != no_material) {
            mesh_.face_materials.push_back(material_);
        }
    }

    /// v, v/t, v//n, v/t/n, and the careless v/ and v//.
    void read_corner(std::string_view corner) {
        const std::size_t slash = corner.find('/');
        mesh_.face_vertices.push_back(to_index(corner.substr(0, slash), mesh_.points.size(), "point"));
        int texcoord = no_texcoord;
        if (slash != std::string_view::npos) {
            const std::string_view rest = corner.substr(slash + 1);
            const std::size_t second = rest.find('/');
            if (const std::string_view index = rest.substr(0, second); !index.empty()) {
                texcoord = to_index(index, mesh_.texcoords.size(), "texture coordinate");
            }
            if (second != std::string_view::npos && second + 1 < rest.size()) {
                cursor_.to_integer(rest.substr(second + 1), "normal of f");
            }
        }
        mesh_.face_texcoords.push_back(texcoord);
    }

    /// An OBJ index from 0. Positive ones may name what comes later in the file: finish_faces() checks them.
    int to_index(std::string_view word, std::size_t defined, std::string_view what) const {
        const std::int64_t index = cursor_.to_integer(word, what);
        if (index == 0) {
            cursor_.fail(fmt::format("{} index 0; OBJ counts from 1", what));
        }
        if (index < 0) {
            if (index < -static_cast<std::int64_t>(defined)) {
                cursor_.fail(fmt::format("{} index {}, but only {} come before; mend the index", what, index,
                                         defined));
            }
            return static_cast<int>(static_cast<std::int64_t>(defined) + index);
        }
        if (index > max_obj_count) {
            cursor_.fail(fmt::format("{} index {} is too large; mend the index", what, index));
        }
        return static_cast<int>(index - 1);
    }

    /// A corner that repeats its neighbour is a mistake everywhere. Others may be meant (an outline that runs
    /// along a bridge to a hole twice); validate_mesh refuses them where the scheme cannot take them.
    void check_distinct(std::size_t first, std::int64_t line) {
        const std::size_t end = mesh_.face_vertices.size();
        int before = mesh_.face_vertices[end - 1];
        for (std::size_t c = first; c < end; ++c) {
            const int point = mesh_.face_vertices[c];
            if (point == before) {
                cursor_.fail_at(line, fmt::format("face names point {} twice in a row; name each corner once",
                                                  point + 1));
            }
            before = point;
        }
    }

    void check_count(std::size_t count, std::string_view what) const {
        if (static_cast<std::int64_t>(count) >= max_obj_count) {
            cursor_.fail(fmt::format("more than {} {}; split the model", max_obj_count, what));
        }
    }

    /// Indices in range, texture coordinates for all faces or none.
    void finish_faces() {
        if (mesh_.face_sizes.empty()) {
            throw UserError(
                fmt::format("{}: no faces; a model needs at least one f line", printable(file_name_, 1000)));
        }
        check_range(mesh_.face_vertices, mesh_.points.size(), "point", "v");
        if (mesh_.texcoords.empty() || !any_textured_) {
            mesh_.face_texcoords.clear();
        } else {
            check_range(mesh_.face_texcoords, mesh_.texcoords.size(), "texture coordinate", "vt");
            if (any_untextured_) {
                std::replace(mesh_.face_texcoords.begin(), mesh_.face_texcoords.end(), no_texcoord,
                             static_cast<int>(mesh_.texcoords.size()));
                mesh_.texcoords.emplace_back(0.0F, 0.0F);
            }
        }
    }

    void check_range(const std::vector<int>& indices, std::size_t defined, std::string_view what,
                     std::string_view keyword) const {
        const auto bad = std::find_if(indices.begin(), indices.end(), [&](int i) {
            return i >= 0 && static_cast<std::size_t>(i) >= defined;
        });
        if (bad == indices.end()) {
            return;
        }
        std::ptrdiff_t corner = bad - indices.begin();
        std::size_t face = 0;
        while (corner >= mesh_.face_sizes[face]) {
            corner -= mesh_.face_sizes[face++];
        }
        cursor_.fail_at(face_lines_[face],
                        fmt::format("face names {} {}, but the file has {} {} line{}; mend the index", what,
                                    std::int64_t{*bad} + 1, defined, keyword, defined == 1 ? "" : "s"));
    }

    ObjCursor cursor_;
    std::string file_name_;
    Mesh mesh_;
    ObjTags tags_;
    ObjMaterialNames* materials_;
    std::unordered_map<std::string, int> material_numbers_;
    int material_ = no_material; // in use
    std::vector<std::int64_t> face_lines_;
    bool any_textured_ = false, any_untextured_ = false;
};

} // namespace

Mesh read_obj(const std::filesystem::path& path) {
    return parse_obj(read_text_file(path, "an OBJ file"), path.string());
}

Mesh parse_obj(std::string_view text, std::string_view file_name, ObjMaterialNames* materials) {
    try {
        return ObjReader(text, file_name, materials).read();
    } catch (const std::bad_alloc&) {
        throw UserError(fmt::format("{}: the model does not fit in memory; give a smaller one",
                                    printable(file_name, 1000)));
    }
}

} // namespace razor
