#include "razor/check/report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace razor::check {

namespace {

struct Kind {
    const char* key;
    Finding MeshReport::*finding;
    const char* what; // {} is the number
    const char* where;
    const char* means;
    const char* mend;
    bool is_warning;
};
constexpr const char* at_edge = "first between points {} and {}";
constexpr const char* at_point = "first point {}";
constexpr const char* at_face = "first face {}";
constexpr Kind kinds[] = {
    {"open_edges", &MeshReport::open_edges, "open edges", at_edge, "rays pass beside them",
     "close the surface if it is meant to be a body", false},
    {"non_manifold_edges", &MeshReport::non_manifold_edges, "edges of more than two faces", at_edge,
     "each is an infinitely sharp crease", "take one of the faces away, or part them", true},
    {"opposed_edges", &MeshReport::opposed_edges, "edges between faces of opposite windings", at_edge,
     "each is an infinitely sharp crease, and normals turn over there", "turn one of the faces over", true},
    {"pinched_points", &MeshReport::pinched_points, "points where separate fans of faces touch", at_point,
     "each is an infinitely sharp corner", "give each fan a point of its own", true},
    {"degenerate_faces", &MeshReport::degenerate_faces, "faces without area", at_face,
     "their normals are those of what is about them, or none", "take them out", true},
    {"slivers", &MeshReport::slivers, "faces more than 10,000 times as long as wide", at_face,
     "their edges take many parts along one side and hardly any along the other", "cut them, or merge them",
     true},
    {"repeated_faces", &MeshReport::repeated_faces, "faces with the points of an earlier one", at_face,
     "of what lies at the same place the first is seen, and shadows fall on the other", "take one out", true},
    {"high_valence_points", &MeshReport::high_valence_points, "points of more than 64 faces", at_point,
     "time and memory of the limit surface there grow as the square of their number",
     "cut the faces in rings", false},
    {"semi_sharp", &MeshReport::semi_sharp, "creases and corners of sharpness between 0 and 10", at_edge,
     "as many levels of subdivision as it says are made apart about each",
     "none is needed; 10 is infinitely sharp", false},
    {"isolated_points", &MeshReport::isolated_points, "points of no face", at_point, "they are not drawn",
     "take them out", false},
    {"hole_faces", &MeshReport::hole_faces, "faces tagged as holes", at_face, "they are not drawn",
     "none is needed if they are meant to be", false},
};

std::string text_of(const BadRay& b) {
    const auto distance = [](double t) { return t < 0 ? std::string("none") : fmt::format("{}", t); };
    const Point &o = b.ray.origin, &d = b.ray.direction;
    return fmt::format(
        "  from ({:a}, {:a}, {:a}) along ({:a}, {:a}, {:a}), base {:a}, growth {:a}: hit at {}, the "
        "surface at {}\n",
        o[0], o[1], o[2], d[0], d[1], d[2], b.ray.base, b.ray.growth, distance(b.t), distance(b.expected));
}

nlohmann::ordered_json json_of(const std::vector<BadRay>& rays) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const BadRay& b : rays)
        json.push_back({{"origin", b.ray.origin},
                        {"direction", b.ray.direction},
                        {"base", b.ray.base},
                        {"growth", b.ray.growth},
                        {"hit", b.t},
                        {"expected", b.expected}});
    return json;
}

} // namespace

std::string text_of(const std::vector<MeshReport>& meshes) {
    std::string text =
        fmt::format("{:<24} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>7} {:>7}\n", "mesh", "points", "faces",
                    "triangles", "quads", "larger", "valence", "bodies", "closed");
    for (const MeshReport& m : meshes) {
        text +=
            fmt::format("{:<24} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>7} {:>7}\n", m.name, m.points, m.faces,
                        m.triangles, m.quads, m.larger, m.largest_valence, m.bodies, m.closed_bodies);
        for (const Kind& kind : kinds) {
            const Finding& f = m.*kind.finding;
            if (f.count > 0)
                text += fmt::format(
                    "  {}: {} {} ({}): {}; {}\n", kind.is_warning ? "warning" : "note", f.count, kind.what,
                    fmt::format(fmt::runtime(kind.where), f.first, f.second), kind.means, kind.mend);
        }
    }
    return text;
}

int warnings_of(const std::vector<MeshReport>& meshes) {
    int n = 0;
    for (const MeshReport& m : meshes)
        for (const Kind& kind : kinds)
            n += kind.is_warning && (m.*kind.finding).count > 0 ? 1 : 0;
    return n;
}

std::string text_of(const EscapeReport& r) {
    std::string text = fmt::format("{} rays from {} points inside, {} patches, {} vertices: {} escape",
                                   r.rays, r.origins, r.patches, r.vertices, r.escapes);
    if (r.escapes > 0)
        text += fmt::format(" ({} through holes that the surface has by definition)", r.holes);
    text += fmt::format("; {:.2f} million rays a second\n",
                        r.seconds > 0 ? 1e-6 * static_cast<double>(r.rays) / r.seconds : 0.0);
    if (r.compared > 0)
        text +=
            fmt::format("{} hits compared with the surface by definition: {} differ; the furthest is off by "
                        "{:.2f} of its rounding bound\n",
                        r.compared, r.different, r.worst);
    for (const auto* rays : {&r.escaped, &r.differing})
        for (const BadRay& b : *rays)
            text += text_of(b);
    return text;
}

nlohmann::ordered_json json_of(const MeshReport& m) {
    nlohmann::ordered_json json{{"name", m.name},
                                {"points", m.points},
                                {"faces", m.faces},
                                {"triangles", m.triangles},
                                {"quads", m.quads},
                                {"larger_faces", m.larger},
                                {"largest_valence", m.largest_valence},
                                {"bodies", m.bodies},
                                {"closed_bodies", m.closed_bodies}};
    for (const Kind& kind : kinds) {
        const Finding& f = m.*kind.finding;
        json[kind.key] = {{"count", f.count}};
        if (f.count > 0)
            json[kind.key]["first"] =
                f.second < 0 ? nlohmann::ordered_json(f.first) : nlohmann::ordered_json{f.first, f.second};
    }
    return json;
}

nlohmann::ordered_json json_of(const EscapeReport& r) {
    nlohmann::ordered_json json{{"rays", r.rays},
                                {"origins", r.origins},
                                {"patches", r.patches},
                                {"vertices", r.vertices},
                                {"escapes", r.escapes},
                                {"escapes_through_holes", r.holes},
                                {"compared", r.compared},
                                {"different", r.different},
                                {"worst_of_bound", r.worst},
                                {"kernel_seconds", r.seconds}};
    json["first_escapes"] = json_of(r.escaped);
    json["first_different"] = json_of(r.differing);
    return json;
}

std::string why_open(const std::vector<MeshReport>& meshes) {
    const auto open = std::find_if(meshes.begin(), meshes.end(),
                                   [](const MeshReport& m) { return m.closed_bodies < m.bodies; });
    if (open == meshes.end())
        return "there is no mesh";
    const MeshReport& m = *open;
    if (m.open_edges.count > 0)
        return fmt::format(
            "mesh {} has {} open edges, the first between its points {} and {} (counted from 0)", m.name,
            m.open_edges.count, m.open_edges.first, m.open_edges.second);
    if (m.non_manifold_edges.count > 0)
        return fmt::format(
            "mesh {} has {} edges of more than two faces, the first between its points {} and {} "
            "(counted from 0)",
            m.name, m.non_manifold_edges.count, m.non_manifold_edges.first, m.non_manifold_edges.second);
    return fmt::format("mesh {} has {} faces tagged as holes, the first is face {} (counted from 0)", m.name,
                       m.hole_faces.count, m.hole_faces.first);
}

std::string text_of(const ConvergenceReport& report) {
    if (!report.converges())
        return "no curved surface was hit often enough to see hits converge\n";
    std::string text = "edges asked for, median error of the distance of hits:\n";
    for (const ConvergenceReport::Step& s : report.steps)
        text += fmt::format("  {:<12.4g} {:<12.4g} of {} hits\n", s.edge, s.median_error, s.hits);
    return text + fmt::format("hits come nearer to the limit surface as the edge to the power of {:.2f}\n",
                              report.order);
}

nlohmann::ordered_json json_of(const ConvergenceReport& report) {
    nlohmann::ordered_json json{{"order", report.order}, {"steps", nlohmann::ordered_json::array()}};
    for (const ConvergenceReport::Step& s : report.steps)
        json["steps"].push_back({{"edge", s.edge}, {"median_error", s.median_error}, {"hits", s.hits}});
    return json;
}

} // namespace razor::check
