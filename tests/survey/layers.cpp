// Names of layers.
#include "razor/survey/layers.h"

#include "razor/image/image.h"
#include "razor/scene/error.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

namespace razor {
namespace {

TEST(Layers, HaveNamesOfTheirGroups) {
    std::set<std::string_view> names;
    int group = 0;
    for (const Layer& layer : all_layers()) {
        EXPECT_TRUE(names.insert(layer.name).second) << layer.name;
        EXPECT_TRUE(layer.name.starts_with(std::string(group_name(layer.group)) + '.')) << layer.name;
        EXPECT_FALSE(layer.meaning.empty());
        EXPECT_EQ(find_layer(layer.name), &layer);
        EXPECT_NE(describe_layers().find(layer.name), std::string::npos);
        EXPECT_GE(static_cast<int>(layer.group), group) << "in the groups' order";
        group = static_cast<int>(layer.group);
    }
    EXPECT_EQ(group, layer_groups - 1);
    for (const Plane& plane : make_film(1, 1).planes)
        EXPECT_EQ(find_layer(plane.name), nullptr);
}

TEST(Layers, AreReadFromAList) {
    const LayerSet some = parse_layers("--layers", "lod,pick,lod", true);
    EXPECT_TRUE(some.has(LayerGroup::lod));
    EXPECT_TRUE(some.has(LayerGroup::pick));
    EXPECT_FALSE(some.has(LayerGroup::kd));
    EXPECT_TRUE(some.has(LayerSource::sight));
    EXPECT_FALSE(some.has(LayerSource::tile));
    const LayerSet all = parse_layers("--layers", "all", true);
    for (int g = 0; g < layer_groups; ++g)
        EXPECT_EQ(all.has(static_cast<LayerGroup>(g)), static_cast<LayerGroup>(g) != LayerGroup::time);
    EXPECT_FALSE(parse_layers("--layers", "all", false).has(LayerGroup::bytes));
    EXPECT_TRUE(parse_layers("--layers", "all,time", true).has(LayerGroup::time));
    EXPECT_TRUE(LayerSet().empty());
}

TEST(Layers, RefuseOthersInOneLine) {
    for (const char* text : {"", "pik", "pick,", ",pick", "pick,kd.depth", "all,everything", "pick lod"})
        try {
            parse_layers("--layers", text, true);
            ADD_FAILURE() << text;
        } catch (const UserError& error) {
            const std::string message = error.what();
            EXPECT_EQ(message.find('\n'), std::string::npos);
            EXPECT_TRUE(message.starts_with("--layers '")) << message;
            EXPECT_NE(message.find("pick, lod"), std::string::npos) << message;
        }
    EXPECT_THROW(parse_layers("--layers", "bytes", false), UserError);
}

TEST(Layers, SayWhereNothingIsHit) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(is_missing(*find_layer("pick.face"), -1));
    EXPECT_FALSE(is_missing(*find_layer("lod.level"), -1));
    EXPECT_TRUE(is_missing(*find_layer("lod.level"), infinity));
    EXPECT_FALSE(is_missing(*find_layer("steps.nodes"), -1));
}

} // namespace
} // namespace razor
