#include "razor/scene/models/obj_tags.h"

#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <string>
#include <string_view>

namespace razor {
namespace {

struct Tag {
    std::string name;
    std::vector<int> ints;
    std::vector<float> floats;
    std::vector<std::string> strings;
};

/// "2/1/0" as three counts.
std::array<std::int64_t, 3> read_counts(ObjCursor& cursor, std::string_view name) {
    const std::string_view word = cursor.word();
    const std::size_t first = word.find('/');
    const std::size_t second = first == std::string_view::npos ? first : word.find('/', first + 1);
    if (second == std::string_view::npos) {
        cursor.fail(fmt::format(
            "tag {} lacks its counts; write nInts/nFloats/nStrings, as in 't crease 2/1/0 3 7 2.5'",
            printable(name)));
    }
    const std::array<std::int64_t, 3> counts{
        cursor.to_integer(word.substr(0, first), "the tag's count of whole numbers"),
        cursor.to_integer(word.substr(first + 1, second - first - 1), "the tag's count of numbers"),
        cursor.to_integer(word.substr(second + 1), "the tag's count of words"),
    };
    for (const std::int64_t count : counts) {
        if (count < 0) {
            cursor.fail(fmt::format("tag {} has a negative count; mend it", printable(name)));
        }
    }
    return counts;
}

Tag read_tag(ObjCursor& cursor) {
    Tag tag;
    tag.name = std::string(cursor.word());
    if (tag.name.empty()) {
        cursor.fail("tag without a name; write 't NAME nInts/nFloats/nStrings ...'");
    }
    const auto [ints, floats, strings] = read_counts(cursor, tag.name);
    for (std::int64_t i = 0; i < ints; ++i) {
        const std::int64_t value = cursor.integer("a whole number of the tag");
        if (value < 0 || value > std::numeric_limits<int>::max()) {
            cursor.fail(fmt::format("tag number {} is out of range; points and faces count from 0", value));
        }
        tag.ints.push_back(static_cast<int>(value));
    }
    for (std::int64_t i = 0; i < floats; ++i) {
        const double value = cursor.number("a number of the tag");
        if (value < 0) {
            cursor.fail(fmt::format("tag value {} is negative; sharpness goes from 0 to {}", value,
                                    infinite_sharpness));
        }
        // Everything from infinite_sharpness on means the same: no overflow in single precision.
        tag.floats.push_back(static_cast<float>(value < 1e6 ? value : 1e6));
    }
    for (std::int64_t i = 0; i < strings; ++i) {
        const std::string_view word = cursor.word();
        if (word.empty()) {
            cursor.fail(fmt::format("tag {} ends early; its counts promise more", printable(tag.name)));
        }
        tag.strings.emplace_back(word);
    }
    if (!cursor.at_statement_end()) {
        cursor.fail(
            fmt::format("tag {} has more values than its counts say; mend the counts", printable(tag.name)));
    }
    return tag;
}

/// Fails unless the tag has this shape, written as in the file.
void require(const ObjCursor& cursor, bool right, std::string_view form) {
    if (!right) {
        cursor.fail(fmt::format("malformed tag; write t {}", form));
    }
}

int choice(const ObjCursor& cursor, const Tag& tag, int count, std::string_view form) {
    require(cursor, tag.ints.size() == 1 && tag.floats.empty() && tag.strings.empty() && tag.ints[0] < count,
            form);
    return tag.ints[0];
}

} // namespace

void ObjTags::read(ObjCursor& cursor, Mesh& mesh) {
    const std::int64_t line = cursor.line();
    const Tag tag = read_tag(cursor);
    if (tag.name == "crease") {
        require(cursor,
                tag.ints.size() == 2 && tag.floats.size() == 1 && tag.strings.empty() &&
                    tag.ints[0] != tag.ints[1],
                "crease 2/1/0 v0 v1 sharpness (one tag an edge, v0 not v1)");
        mesh.creases.push_back({tag.ints[0], tag.ints[1], tag.floats[0]});
        crease_lines_.push_back(line);
    } else if (tag.name == "corner") {
        require(cursor,
                !tag.ints.empty() && (tag.floats.size() == 1 || tag.floats.size() == tag.ints.size()) &&
                    tag.strings.empty(),
                "corner 1/1/0 v sharpness");
        for (std::size_t i = 0; i < tag.ints.size(); ++i) {
            mesh.corners.push_back({tag.ints[i], tag.floats[tag.floats.size() == 1 ? 0 : i]});
            corner_lines_.push_back(line);
        }
    } else if (tag.name == "hole") {
        require(cursor, !tag.ints.empty() && tag.floats.empty() && tag.strings.empty(), "hole 1/0/0 face");
        mesh.holes.insert(mesh.holes.end(), tag.ints.begin(), tag.ints.end());
        hole_lines_.insert(hole_lines_.end(), tag.ints.size(), line);
    } else if (tag.name == "interpolateboundary") {
        constexpr std::array values{BoundaryInterpolation::none, BoundaryInterpolation::edge_and_corner,
                                    BoundaryInterpolation::edge_only};
        mesh.boundary = values[static_cast<std::size_t>(choice(
            cursor, tag, 3, "interpolateboundary 1/0/0 m (m: 0 none, 1 edge and corner, 2 edge only)"))];
    } else if (tag.name == "facevaryinginterpolateboundary") {
        mesh.face_varying = static_cast<FaceVaryingInterpolation>(
            choice(cursor, tag, 6, "facevaryinginterpolateboundary 1/0/0 m (m from 0, none, to 5, all)"));
    } else if (tag.name == "creasemethod") {
        require(cursor,
                tag.ints.empty() && tag.floats.empty() && tag.strings.size() == 1 &&
                    (tag.strings[0] == "normal" || tag.strings[0] == "chaikin"),
                "creasemethod 0/0/1 METHOD (normal or chaikin)");
        mesh.crease_method = tag.strings[0] == "chaikin" ? CreaseMethod::chaikin : CreaseMethod::normal;
    } else if (tag.name == "smoothtriangles") {
        require(cursor,
                tag.ints.empty() && tag.floats.empty() && tag.strings.size() == 1 &&
                    (tag.strings[0] == "catmark" || tag.strings[0] == "smooth"),
                "smoothtriangles 0/0/1 RULE (catmark or smooth)");
        mesh.triangles =
            tag.strings[0] == "smooth" ? TriangleSubdivision::smooth : TriangleSubdivision::catmull_clark;
    } else {
        cursor.fail_at(line,
                       fmt::format("unknown tag '{}'; known: crease, corner, hole, interpolateboundary, "
                                   "facevaryinginterpolateboundary, creasemethod, smoothtriangles",
                                   printable(tag.name)));
    }
}

void ObjTags::finish(const ObjCursor& cursor, const Mesh& mesh) const {
    const auto check = [&](int index, std::size_t count, std::string_view what, std::int64_t line) {
        if (static_cast<std::size_t>(index) >= count) {
            cursor.fail_at(line, fmt::format("tag names {} {}, but they go from 0 to {}; tags count from 0",
                                             what, index, static_cast<std::int64_t>(count) - 1));
        }
    };
    for (std::size_t i = 0; i < mesh.creases.size(); ++i) {
        check(mesh.creases[i].v0, mesh.points.size(), "point", crease_lines_[i]);
        check(mesh.creases[i].v1, mesh.points.size(), "point", crease_lines_[i]);
    }
    for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
        check(mesh.corners[i].vertex, mesh.points.size(), "point", corner_lines_[i]);
    }
    for (std::size_t i = 0; i < mesh.holes.size(); ++i) {
        check(mesh.holes[i], mesh.face_sizes.size(), "face", hole_lines_[i]);
    }
}

} // namespace razor
