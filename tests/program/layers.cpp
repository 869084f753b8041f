// razor render --layers and --false-colour: what is in files, and mistakes.
#include "tests/program/pictures.h"
#include "tests/program/run.h"
#include "tests/scene/scene_texts.h"

#include <set>

namespace razor {
namespace {

const std::string scene = R"(
    [settings]
    size = [40, 24]
    samples = 2
    [camera]
    position = [0, 2, 6]
)" + lamp_text + floor_and_gear_text +
                          R"(
    [[object]]
    mesh = "gear"
    [[object]]
    mesh = "floor"
)";

class Layers : public ::testing::Test {
protected:
    Layers() { folder_.file("scene.toml", scene); }

    Outcome render(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " render scene.toml --threads 1 " + arguments,
                   folder_.path());
    }
    void expect_rendered(const std::string& arguments) const {
        const Outcome result = render(arguments);
        EXPECT_EQ(result.code, 0) << result.err;
    }
    void expect_refused(const std::string& arguments, const std::string& cause) const {
        SCOPED_TRACE(arguments);
        const std::size_t before = folder_.count();
        const Outcome result = render(arguments);
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(folder_.count(), before) << "a file was left";
    }

    TemporaryFolder folder_;
};

TEST_F(Layers, AreInTheFileBesideAllElse) {
    expect_rendered("-o plain.exr");
    expect_rendered("--layers pick,steps,shading -o more.exr");
    const Film plain = read_exr(folder_ / "plain.exr"), more = read_exr(folder_ / "more.exr");
    for (const Plane& plane : plain.planes)
        EXPECT_EQ(more.find(plane.name)->values, plane.values) << plane.name;
    std::set<std::string> groups;
    for (const Plane& plane : more.planes)
        if (plain.find(plane.name) == nullptr)
            groups.insert(plane.name.substr(0, plane.name.find('.')));
    EXPECT_EQ(groups, (std::set<std::string>{"pick", "shading", "steps"}));
    const std::vector<std::uint32_t>& meshes = more.find("pick.mesh")->ids;
    EXPECT_EQ(std::set(meshes.begin(), meshes.end()), (std::set<std::uint32_t>{0, 1, no_id}));
    for (const char* const name : {"pick.instance", "pick.face", "pick.part"})
        EXPECT_EQ(more.find(name)->ids.size(), more.pixel_count()) << name;
    for (const char* const name : {"pick.u", "pick.v", "pick.Z"})
        EXPECT_TRUE(more.find(name)->ids.empty()) << name;
}

/// Larger names than floats tell apart, by all that reads layers.
TEST_F(Layers, NamesAreExactInFiles) {
    const std::vector<std::uint32_t> ids{16777216, 16777217, 16777219, 4294967294, 0, no_id};
    const auto write = [&](const char* name, std::uint32_t first) {
        Film film(3, 2);
        for (const char* const plane : {"R", "G", "B"})
            film.add(plane).values = {1, 2, 3, 4, 5, 6};
        film.add_ids("pick.face").ids = ids;
        film.add("pick.u").values = {0.25F, 0.5F, -1, 1, 0, -1};
        film.find("pick.face")->ids[0] = first;
        write_exr(folder_ / name, film);
        return film;
    };
    const Film film = write("a.exr", 16777216);
    write("b.exr", 16777217);
    const Film again = read_exr(folder_ / "a.exr");
    EXPECT_EQ(again.find("pick.face")->ids, ids);
    EXPECT_TRUE(again.find("pick.face")->values.empty());
    EXPECT_EQ(again.find("pick.u")->values, film.find("pick.u")->values);
    EXPECT_EQ(again.find("pick.face")->at(3), 4294967294.0);
    EXPECT_EQ(again.find("pick.face")->at(5), -1);
    const auto compare = [&](const std::string& arguments) {
        return run(quoted_argument(RAZOR_PROGRAM) + " compare " + arguments, folder_.path());
    };
    EXPECT_EQ(compare("--identical a.exr a.exr").code, 0);
    EXPECT_EQ(compare("--identical a.exr b.exr").code, 1) << "floats of both are the same";
    EXPECT_EQ(compare("a.exr b.exr -o d.exr").code, 0);
    EXPECT_EQ(read_exr(folder_ / "d.exr").find("pick.face")->values[0], -1);
    const Outcome python = run("/usr/bin/python3 -c \"import sys; sys.path.insert(0, '" RAZOR_SOURCE_DIR
                               "/analysis/sampling'); import exr; w, h, p = exr.read('a.exr'); "
                               "print(w, h, *p['pick.face'], *p['pick.u'])\"",
                               folder_.path());
    EXPECT_EQ(python.out,
              "3 2 16777216 16777217 16777219 4294967294 0 4294967295 0.25 0.5 -1.0 1.0 0.0 -1.0\n")
        << python.err;
}

TEST_F(Layers, OfASequenceAreThoseOfItsFrames) {
    expect_rendered("--layers pick,lod --frames 0:1 -o s%d.exr");
    expect_rendered("--layers pick,lod --frame 1 -o one.exr");
    expect_same_picture(folder_ / "one.exr", folder_ / "s1.exr");
}

TEST_F(Layers, AreShownInFalseColours) {
    const Outcome all = render("--false-colour lod.depth --range 0:4 -o lod.png -o lod.exr");
    EXPECT_EQ(all.out, "lod.depth: 0 (dark) to 4 (bright); black: nothing\n");
    EXPECT_NE(read_exr(folder_ / "lod.exr").find("lod.depth"), nullptr);
    const Outcome first = render("--false-colour kd -o kd.png");
    EXPECT_TRUE(first.out.starts_with("kd.depth: ")) << first.out;
    EXPECT_EQ(render("--false-colour pick.mesh -o mesh.png").out,
              "pick.mesh: a colour for each number; black: nothing\n");
    EXPECT_EQ(render("--false-colour depth.Z --quiet -o depth.png").out, "");
    const auto bytes = [&](const char* name) {
        std::ifstream file(folder_ / name, std::ios::binary);
        return std::string((std::istreambuf_iterator<char>(file)), {});
    };
    std::set<std::string> pictures{bytes("lod.png"), bytes("kd.png"), bytes("mesh.png"), bytes("depth.png")};
    EXPECT_EQ(pictures.size(), 4U);
    render("--false-colour lod.depth --range 0:1 -o lod1.png");
    EXPECT_NE(bytes("lod.png"), bytes("lod1.png"));
}

TEST_F(Layers, AreRefusedInOneLine) {
    expect_refused("--layers pick,kdd -o a.exr", "--layers 'kdd' is unknown; did you mean 'kd'?");
    expect_refused("--layers pick -o a.png", "--layers go into EXR files");
    expect_refused("--layers pick --stats a.json", "--layers go into EXR files");
    expect_refused("--false-colour lod.lvel -o a.png",
                   "--false-colour 'lod.lvel' is no layer; did you mean 'lod.level'?");
    expect_refused("--false-colour lod -o a.exr", "--false-colour is of PNG files");
    expect_refused("--range 0:1 -o a.png", "--range without --false-colour");
    expect_refused("--false-colour lod --range 0 -o a.png", "--range '0' is not possible");
    expect_refused("--false-colour lod --range 4:1 -o a.png", "--range '4:1' ends before it begins");
    expect_refused("--false-colour lod --range a:1 -o a.png", "the low end of --range 'a' is not possible");
    expect_refused("--false-colour lod --tone aces -o a.png", "--false-colour shows no light");
    expect_refused("--layers pick --trace t.rzt -o a.exr", "leave out --layers");
}

} // namespace
} // namespace razor
