// What displacement cannot be made of is refused in one line.
#include "razor/frame/frame.h"
#include "razor/scene/error.h"
#include "tests/displacement/heights.h"
#include "tests/kernels/cages.h"

#include <gtest/gtest.h>

#include <limits>

namespace razor::test {
namespace {

std::string refusal(const Scene& scene) {
    try {
        const Frame frame(scene, {});
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(DisplacementRefusals, SayWhatIsMissing) {
    Scene scene = displaced_scene(with_seams(cube_cage()), 20, smooth_heights(), 0.1, 0.5);
    EXPECT_EQ(refusal(scene), "");
    Scene bare = scene;
    bare.meshes[0].texcoords.clear();
    bare.meshes[0].face_texcoords.clear();
    EXPECT_NE(refusal(bare).find("no texture coordinates"), std::string::npos) << refusal(bare);
    Scene unread = scene;
    unread.textures[0].heights = nullptr;
    EXPECT_NE(refusal(unread).find("heights were not read"), std::string::npos) << refusal(unread);
    Scene solid = scene;
    solid.textures[0] = pattern_heights(PatternKind::noise);
    EXPECT_EQ(refusal(solid), "");
    solid.textures[0].pattern->space = PatternSpace::object;
    EXPECT_NE(refusal(solid).find("a pattern of points"), std::string::npos) << refusal(solid);
    for (const float scale :
         {1e35F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        Scene far = scene;
        far.materials[0].displacement_scale = scale;
        EXPECT_NE(refusal(far).find("too far"), std::string::npos) << refusal(far);
    }
}

} // namespace
} // namespace razor::test
