// Scene graphs that cannot be drawn are refused, each with its cause.
#include "tests/scene/random_graph.h"

#include "razor/scene/error.h"

#include <gtest/gtest.h>

namespace razor {
namespace {

std::string refusal(const SceneGraph& graph, const std::vector<Box>& boxes) {
    try {
        flatten(graph, boxes);
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

TEST(FlatGraph, RefusesWhatCannotBeDrawn) {
    const std::vector<Box> boxes{unit_box};
    const auto root = [](Placement p) { return SceneGraph{{{"root", {std::move(p)}}}}; };
    const auto expect = [&](const SceneGraph& graph, std::string_view cause) {
        const std::string message = refusal(graph, boxes);
        EXPECT_NE(message.find(cause), std::string::npos) << message << "\n not: " << cause;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    };
    expect({{{"root", {}}}}, "places no mesh");
    expect({{{"a", {place_group(0)}}}}, "groups contain each other ('a' in 'a')");
    expect({{{"r", {place_group(1)}},
             {"a", {place(0), place_group(2)}},
             {"b", {place_group(3)}},
             {"c", {place_group(1)}}}},
           "groups contain each other ('a' in 'b' in 'c' in 'a'); remove one");
    expect({{{"r", {place(0)}}, {"a", {place_group(2)}}, {"b", {place_group(1)}}}}, "('a' in 'b' in 'a')");
    SceneGraph doubling;
    for (int g = 0; g < 70; ++g) {
        doubling.groups.push_back(
            {"g", {g < 69 ? place_group(g + 1) : place(0), g < 69 ? place_group(g + 1) : place(0)}});
    }
    expect(doubling, "more than 4194304 instances");
    Placement many = place(0);
    many.copies = glm::ivec3(1000000);
    expect(root(many), "more than 4194304 instances");
    expect(root(place(0, scaled(0))), "object 'mesh' is flattened");
    expect(root(place(0, {.scale = {1, 1e-10, 1}})),
           "is flattened: its world transform scales by 1 in one direction and "
           "by 1e-10 in another");
    // Each is fine by itself, their product is not.
    const Transform thin{.scale = {1, 1e-5, 1}};
    expect({{{"r", {place_group(1, thin)}}, {"g", {place(0, thin)}}}}, "object 'group/mesh' is flattened");
    EXPECT_EQ(refusal({{{"r", {place_group(1, thin)}}, {"g", {place(0, {.scale = {1, 1e5, 1}})}}}}, boxes),
              "");
    expect({{{"r", {place_group(1, scaled(1e-20))}}, {"g", {place(0, scaled(1e-20))}}}},
           "is scaled by 1e-40");
    expect({{{"r", {place_group(1, scaled(1e20))}}, {"g", {place(0, scaled(1e20))}}}}, "is scaled by 1e+40");
    expect(root(place(0, scaled(1.000000001e30))),
           "is scaled by 1.000000001e+30 in the world; keep scales from 1e-30 to 1e+30");
    expect(root(place(0, scaled(0.999999999e-30))), "is scaled by 9.99999999e-31 in the world; keep");
    expect(root(place(0, {.translate = {1.1e30, 0, 0}})), "reaches beyond 1e+30");
    EXPECT_EQ(refusal(root(place(0, {.translate = {9.9e29, 0, 0}})), boxes), "");
    Placement faint = place_group(1);
    faint.rate = 1e-4;
    Placement faint_mesh = place(0);
    faint_mesh.rate = 1e-4;
    expect({{{"r", {faint}}, {"g", {faint_mesh}}}}, "has rates that multiply to 1e-08");
    Placement coarse = place_group(1);
    coarse.level_offset = 33;
    Placement coarse_mesh = place(0);
    coarse_mesh.level_offset = 32;
    expect({{{"r", {coarse}}, {"g", {coarse_mesh}}}}, "has level offsets that add up to 65");
}

} // namespace
} // namespace razor
