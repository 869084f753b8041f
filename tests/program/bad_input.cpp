// razor on mistakes: exit code 2, exactly one line on the error stream, no output file. And on a good scene:
// whole files.
#include "razor/image/exr.h"
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <random>
#include <set>

namespace razor {
namespace {

constexpr std::string_view triangle = "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n";

/// A folder with small good and bad files, for razor to run in.
class Razor : public ::testing::Test {
protected:
    Razor() {
        folder_.file("good.obj", triangle);
        folder_.file("good.toml", "[[mesh]]\nfile = \"good.obj\"\n");
        folder_.file("empty.obj", "");
        folder_.file("empty.toml", "");
        std::mt19937 random(7); // NOLINT(cert-msc32-c,cert-msc51-cpp)
        std::string noise(5000, '\0');
        for (char& c : noise) {
            c = static_cast<char>(random());
        }
        folder_.file("random.obj", noise);
        folder_.file("random.toml", noise);
        folder_.file("random.ply", noise);
        folder_.file("cut.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
                                "property float y\nproperty float z\nelement face 1\n"
                                "property list uchar int vertex_indices\nend_header\n" +
                                    std::string(36, '\0'));
        folder_.file("view.toml", "[camera]\nfrom = \"good.obj\"\n[[mesh]]\nfile = \"good.obj\"\n");
        folder_.file("random.exr", noise);
        folder_.file("key.toml", "[settings]\nsamlpes = 3\n[[mesh]]\nfile = \"good.obj\"\n");
        folder_.file("type.toml", "[settings]\nsamples = \"3\"\n[[mesh]]\nfile = \"good.obj\"\n");
        folder_.file("range.toml", "[settings]\nsize = [0, 5]\n[[mesh]]\nfile = \"good.obj\"\n");
        folder_.file("good.instances", "good.obj 0 0 0\ngood.obj 1 2 3 90 0.5\n");
        folder_.file("empty.instances", "");
        folder_.file("random.instances", noise);
        folder_.file("row.instances", "good.obj 0 0 0\ngood.obj 0 0\n");
        folder_.file("lost.instances", "good.obj 0 0 0\nlost.obj 0 0 0\n");
        folder_.file("far.instances", "good.obj 1e30 0 0 0 1e30\n");
        folder_.file("flat.toml",
                     "[[mesh]]\nname = \"a\"\nfile = \"good.obj\"\n[[object]]\nmesh = \"a\"\nscale = 0\n");
        folder_.file("cycle.toml", "[[group]]\nname = \"a\"\n[[group.object]]\ngroup = \"a\"\n");
        folder_.file(
            "many.toml",
            "[[mesh]]\nname = \"a\"\nfile = \"good.obj\"\n[[object]]\nmesh = \"a\"\narray = [3000, 3000, "
            "1]\nspacing = [1, 1, 1]\n");
        folder_.file("lost.toml", "[[mesh]]\nfile = \"lost.obj\"\n");
        std::filesystem::create_directory(folder_ / "folder.obj");
        std::filesystem::create_directory(folder_ / "folder.toml");
    }

    Outcome razor(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " " + arguments, folder_.path());
    }

    /// Those that --stats NAME.json wrote.
    nlohmann::json statistics(const std::string& name) const {
        std::ifstream file(folder_ / (name + ".json"));
        return nlohmann::json::parse(file).at("statistics");
    }

    void expect_refused(const std::string& arguments, const std::string& cause) const {
        SCOPED_TRACE("razor " + arguments);
        const std::size_t before = folder_.count();
        const Outcome result = razor(arguments);
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_TRUE(result.err.starts_with("razor: ")) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(folder_.count(), before) << "a file was left";
    }

    TemporaryFolder folder_;
};

TEST_F(Razor, RefusesBadInput) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"none.obj", "none.obj: no such file"},
        {"none.toml", "none.toml: no such file"},
        {"folder.obj", "folder.obj: is a directory"},
        {"folder.toml", "folder.toml: is a directory"},
        {".", "is a directory"},
        {"''", "scene '' is empty; give FILE, or leave it out"},
        {"good.obj --nosuch", "unknown option --nosuch; see razor render --help"},
        {"empty.obj", "empty.obj: is empty"},
        {"empty.toml", "empty.toml: is empty"},
        {"random.obj", "random.obj:1: "},
        {"random.toml", "random.toml:1:"},
        {"random.ply", "random.ply:1: begins with"},
        {"cut.ply", "cut.ply:7: element face 1 does not fit into the 0 bytes that are left of the file"},
        {"view.toml", "view.toml:2:8: 'good.obj' brings no camera; give a .gltf or .glb file"},
        {"random.exr", "neither a scene file nor a model"},
        {"key.toml", "key.toml:2:1: unknown key 'settings.samlpes'; did you mean 'samples'?"},
        {"type.toml", "type.toml:2:11: settings.samples is text"},
        {"range.toml", "range.toml:2:9: settings.size = 0 is out of range"},
        {"lost.toml", "lost.obj: no such file"},
        {"empty.instances", "empty.instances: is empty"},
        {"random.instances", "random.instances:"},
        {"row.instances", "row.instances:2: 2 numbers after the file name"},
        {"lost.instances", "lost.instances:2: "},
        {"far.instances", "far.instances: object 'far/line 1' reaches beyond 1e+30"},
        {"flat.toml", "flat.toml:6:9: the object's scale flattens it"},
        {"cycle.toml", "cycle.toml:2:8: groups contain each other ('a' in 'a')"},
        {"many.toml", "many.toml:4:1: the scene graph has more than 4194304 instances"},
        {"good.obj --size 0x5", "--size"},
        {"good.obj --size 512", "--size '512'"},
        {"good.obj --size 5x-5", "--size"},
        {"good.obj --size 99999x99999", "--size"},
        {"good.obj --spp 0", "--spp '0'"},
        {"good.obj --spp 1e3", "--spp '1e3'"},
        {"good.obj --threads 0", "--threads '0'"},
        {"good.obj --filter gauss", "--filter 'gauss' is unknown; give one of: box, triangle"},
        {"good.obj --filter-radius 0", "--filter-radius '0' is not possible; give a number from 0.01 to 32"},
        {"good.obj --filter lanczos --filter-radius nan", "--filter-radius 'nan'"},
        {"good.obj --tone agxx", "--tone 'agxx' is unknown; give one of: srgb, aces, agx"},
        {"good.obj --time 10", "--time '10' is not possible; give a time from 1ms to 1000h"},
        {"good.obj --time -1s", "--time '-1s' is not possible"},
        {"good.obj --progressive --repeat 2", "rendered once; leave out --repeat"},
        {"good.obj --progressive --frames 0:1", "--progressive writes one frame's pictures"},
        {"good.obj --threads many", "--threads 'many'"},
        {"good.obj --isa mmx", "--isa 'mmx' is unknown; give one of: auto, plain, sse4, avx2, avx512"},
        {"good.obj --share core", "--share 'core'"},
        {"good.obj --share 0", "--share '0'"},
        {"good.obj --share 99999999999", "--share"},
        {"good.obj --memory 256", "--memory '256' is not possible; give a size from 64KiB to 1024GiB"},
        {"good.obj --memory 256MB", "--memory '256MB'"},
        {"good.obj --memory MiB", "--memory 'MiB'"},
        {"good.obj --memory -1MiB", "--memory '-1MiB'"},
        {"good.obj --memory nanMiB", "--memory 'nanMiB'"},
        {"good.obj --memory 1e99GiB", "--memory '1e99GiB'"},
        {"good.obj --memory 63KiB", "--memory '63KiB'"},
        {"good.obj --eager --memory 1GiB", "leave --memory out"},
        {"good.obj --size 64x64 --edge-pixels 0.05 --memory 64KiB",
         "a memory budget of 64.0 KiB is too small: one screen tile alone needs more than that; raise "
         "--memory"},
        {"good.obj --scheme loop", "--scheme 'loop'"},
        {"good.obj --up x", "--up 'x'"},
        {"good.obj --edge-pixels nan", "--edge-pixels 'nan'"},
        {"good.obj --sise 4x4", "unknown option --sise; did you mean --size?"},
        {"good.obj good.toml", "good.toml"},
        {"good.obj --stats none/s.json", "none"},
        {"good.obj --stats .", "is a directory"},
        {"good.obj --stats -", "--stats: - stands for no file here; give its name"},
        {"good.obj -o x.jpg", "end the name in .exr or .png"},
        {"good.obj -o none/x.png", "no folder none"},
        {"good.obj -o folder.obj", "end the name in .exr or .png"},
    };
    for (const auto& [arguments, cause] : cases) {
        expect_refused("render " + arguments + " -o picture.exr", cause);
    }
    expect_refused("", "subcommand");
    expect_refused("rendr good.obj -o picture.exr", "unknown command rendr; did you mean render?");
    expect_refused("render good.obj", "no output; add -o");
    expect_refused("render good.obj -o picture.exr --spp", "--spp: 1 required");
    expect_refused("--sise", "--sise");
    for (const char* light : {"--exposure 1", "--tone agx"})
        expect_refused(std::string("render good.obj -o picture.exr ") + light, "are of PNG files");
    for (const char* scene : {"good.toml", ""}) {
        expect_refused(std::string("render ") + scene + " -o picture.exr --up z",
                       "--up z: turns bare models");
        expect_refused(std::string("render ") + scene + " -o picture.exr --no-floor",
                       "--no-floor: only bare models");
    }
    expect_refused("render good.toml -o picture.exr --crease-angle 30", "state crease_angle in the [[mesh]]");
    expect_refused("render good.obj -o picture.exr --crease-angle 30",
                   "--crease-angle: only MD3 and glTF models have normals instead of creases; leave it out");
    expect_refused("render none.glb -o picture.exr --crease-angle 200",
                   "--crease-angle '200' is not possible; give a number from 0 to 180");
    expect_refused("export-mesh good.obj", "--output is required");
    expect_refused("export-mesh good.obj -o mesh.ply", "mesh.ply: the mesh is written as OBJ only");
    expect_refused("export-mesh good.obj -o none/mesh.obj", "no folder none");
    expect_refused("export-mesh none.obj -o mesh.obj", "none.obj: no such file");
    expect_refused("export-mesh good.obj -o mesh.obj --isa mmx",
                   "--isa mmx: this build on this processor has");
}

TEST_F(Razor, RefusesEmptyValues) {
    for (const char* option : {"--size",          "--spp",           "--crop",
                               "--filter",        "--filter-radius", "--noise-threshold",
                               "--light-samples", "--seed",          "--edge-pixels",
                               "--lod",           "--frame",         "--frames",
                               "--scheme",        "--crease-angle",  "--threads",
                               "--memory",        "--time",          "--target-error",
                               "--exposure",      "--layers",        "--false-colour",
                               "--range",         "--stats",         "--trace",
                               "--output"})
        expect_refused(std::string("render good.obj -o picture.exr ") + option + " ''",
                       std::string(option) + " '' is empty; give ");
    expect_refused("render good.obj -o picture.exr --stats= --quiet", "--stats= is empty; give it a value");
    expect_refused("render -o ''", "--output '' is empty; give FILE, or leave it out");
    expect_refused("export-mesh good.obj -o ''", "--output '' is empty; give FILE.obj");
    expect_refused("info good.obj --json ''", "--json '' is empty");
    expect_refused("check good.obj --escape ''", "--escape '' is empty");
}

TEST_F(Razor, NamesTheFileOfAMesh) {
    std::string many = "f", points;
    for (int i = 1; i <= 300; ++i) {
        points += "v " + std::to_string(i % 150) + " " + std::to_string(i) + " 0\n";
        many += " " + std::to_string(i);
    }
    folder_.file("many.obj", points + many + "\n");
    folder_.file("scene.toml", "[[mesh]]\nname = \"m\"\nfile = \"many.obj\"\n");
    const std::string file = (folder_ / "many.obj").string();
    for (const char* command :
         {"render many.obj -o p.exr", "check many.obj", "export-mesh many.obj -o o.obj"})
        expect_refused(command, file +
                                    ": mesh 'many': face 0 (counted from 0) has 300 corners; a subdivision "
                                    "face may have at most 256, so split it, or render the mesh as bilinear");
    expect_refused("render scene.toml -o p.exr", file + ": mesh 'm': face 0");
    folder_.file("bare.toml", "[[texture]]\nname = \"t\"\npattern = \"checker\"\nspace = \"texture\"\n"
                              "[[material]]\nname = \"squares\"\nalbedo_map = \"t\"\n"
                              "[[mesh]]\nfile = \"good.obj\"\n");
    for (const char* command :
         {"render bare.toml -o p.exr", "check bare.toml", "export-mesh bare.toml -o o.obj",
          "render bare.toml --target-error 0.1 -o p.exr"})
        expect_refused(command,
                       (folder_ / "good.obj").string() +
                           ": mesh 'good': it has no texture coordinates, but its material 'squares' has "
                           "a texture; give it another material or a mesh with coordinates");
    std::filesystem::create_directory(folder_ / "pictures");
    folder_.file("textures.toml", "[[texture]]\nname = \"t\"\nfile = \"pictures\"\n");
    expect_refused("render textures.toml -o p.exr", "textures.toml:3:8: " + (folder_ / "pictures").string() +
                                                        ": is a directory; give a picture");
}

TEST_F(Razor, SaysWhichLibraryIsNotThere) {
    folder_.file("red.obj", "mtllib none.mtl\nusemtl red\n" + std::string(triangle));
    const std::string note = (folder_ / "red.obj").string() +
                             ": goes on without its material library 'none.mtl'; put it beside the model\n";
    for (const char* command : {"info red.obj", "check red.obj --json c.json"})
        EXPECT_NE(razor(command).out.find("not read: " + note), std::string::npos) << command;
    std::ifstream file(folder_ / "c.json");
    EXPECT_EQ(nlohmann::json::parse(file).at("notes").size(), 1U);
    EXPECT_EQ(razor("render red.obj --size 8x8 --spp 1 -o red.exr").err, "razor: " + note);
}

TEST_F(Razor, SaysWhatCannotBeSaid) {
    if (!std::filesystem::exists("/dev/full"))
        GTEST_SKIP();
    for (const std::string what : {"--help", "--version", "render --help"}) {
        const Outcome result =
            run("sh -c " + quoted_argument(quoted_argument(RAZOR_PROGRAM) + " " + what + " > /dev/full"),
                folder_.path());
        EXPECT_EQ(result.code, 2) << what;
        EXPECT_TRUE(result.err.starts_with("razor: standard output: cannot be written")) << result.err;
    }
}

/// What is exported is a scene again: of a model, that alone.
TEST_F(Razor, WritesMeshesThatItReads) {
    const Outcome result = razor("export-mesh good.obj --no-floor --lod recursive -o mesh.obj");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("mesh.obj: "), std::string::npos) << result.out;
    EXPECT_EQ(razor("export-mesh good.obj --lod recursive -o bare.obj").out.substr(4), result.out.substr(4))
        << "no floor either";
    const Outcome again = razor("render mesh.obj --size 8x8 --quiet -o again.exr");
    EXPECT_EQ(again.code, 0) << again.err;
    const std::size_t before = folder_.count();
    const Outcome full =
        run("ulimit -f 4; trap '' XFSZ; " + quoted_argument(RAZOR_PROGRAM) + " export-mesh -o big.obj",
            folder_.path());
    EXPECT_EQ(full.code, 2) << full.err;
    EXPECT_EQ(full.error_lines(), 1) << full.err;
    EXPECT_EQ(folder_.count(), before);
}

TEST_F(Razor, LoadsOrRefusesEveryOddFile) {
    const std::filesystem::path odd = std::filesystem::path(RAZOR_SHARED_SCENES) / "odd";
    if (!std::filesystem::exists(odd)) {
        GTEST_SKIP() << "no shared scenes in " << odd;
    }
    const std::set<std::string> refused{"box_longline.obj", "concave_polygon.obj", "empty.obj",
                                        "notenoughindices.obj"};
    const std::set<std::string> noted{"polygonfaces.obj", "singlevn.obj"}; // their library is not there
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(odd)) {
        const std::string name = entry.path().filename().string();
        ++files;
        if (refused.contains(name)) {
            // Faces that a cage cannot have are refused by file, mesh and face, all else by file and line.
            expect_refused("render " + quoted_argument(entry.path().string()) + " -o picture.exr --quiet",
                           "/" + name + ":");
        } else {
            const Outcome result =
                razor("render " + quoted_argument(entry.path().string()) + " -o p.exr --size 24x16 --spp 1");
            EXPECT_EQ(result.code, 0) << name << ": " << result.err;
            EXPECT_EQ(result.error_lines(), noted.contains(name) ? 1 : 0)
                << "quiet in a pipe: " << result.err;
            EXPECT_EQ(read_exr(folder_ / "p.exr").width, 24);
            std::filesystem::remove(folder_ / "p.exr");
        }
    }
    EXPECT_GE(files, 13U);
}

/// Blocks with longer edges beside them, whose normals are made, as mirrors are hit, before finer blocks are:
/// boxes of these once depended on it, and rays passed beside them.
TEST_F(Razor, WhatWasMadeBeforeChangesNoBit) {
    for (const std::string lod : {"recursive", "discrete", "patch"}) {
        folder_.file("knot.toml",
                     "[settings]\nsize = [64, 64]\nsamples = 4\nedge_pixels = 2\nshading = \"hits\"\n"
                     "bounces = 2\nlod = \"" +
                         lod +
                         "\"\n"
                         "[camera]\nposition = [0, 1.2, 2.2]\ntarget = [0, 0, 0]\n"
                         "[sky]\nradiance = 0.3\n[[material]]\nname = \"m\"\nkind = \"mirror\"\n"
                         "[[mesh]]\nshape = \"knot\"\nmaterial = \"m\"\n");
        ASSERT_EQ(razor("render knot.toml --threads 1 -o a.exr").code, 0);
        for (const char* const how : {"--threads 1 --eager", "--threads 3 --share worker", "--threads 2"}) {
            ASSERT_EQ(razor(std::string("render knot.toml -o b.exr ") + how).code, 0) << how;
            const Outcome same = razor("compare --identical a.exr b.exr");
            EXPECT_EQ(same.code, 0) << lod << ", " << how << ": " << same.out;
        }
    }
}

TEST_F(Razor, EagerFramesAreTheSamePicture) {
    const std::string rest = " --size 20x10 --spp 1 --threads 2 ";
    ASSERT_EQ(razor("render" + rest + "-o lazy.exr --stats lazy.json").code, 0);
    const Outcome eager = razor("render" + rest + "-o eager.exr --stats eager.json --eager");
    ASSERT_EQ(eager.code, 0) << eager.err;
    const Film expected = read_exr(folder_ / "lazy.exr"), film = read_exr(folder_ / "eager.exr");
    for (const Plane& plane : expected.planes)
        EXPECT_EQ(film.find(plane.name)->values, plane.values) << plane.name;
    EXPECT_GT(statistics("lazy").at("left_out").at("nodes_never_split"), 0);
    EXPECT_EQ(statistics("lazy").at("host").at("frames").at(0).at("eager_seconds"), 0);
    EXPECT_EQ(statistics("eager").at("left_out").at("nodes_never_split"), 0);
    EXPECT_EQ(statistics("eager").at("left_out").at("patches_never_opened"), 0);
    EXPECT_GT(statistics("eager").at("host").at("frames").at(0).at("eager_seconds"), 0);
    const Outcome apart = razor("render" + rest + "-o e.exr --eager --share worker");
    EXPECT_EQ(apart.code, 2);
    EXPECT_EQ(apart.err, "razor: --eager builds one kd-tree; leave --share out\n");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "e.exr"));
}

TEST_F(Razor, StaysWithinItsMemory) {
    const std::string rest = " --size 64x64 --spp 1 --threads 2 ";
    ASSERT_EQ(razor("render" + rest + "-o all.exr --stats all.json").code, 0);
    const Outcome bounded = razor("render" + rest + "-o some.exr --stats some.json --memory 1.25MiB");
    ASSERT_EQ(bounded.code, 0) << bounded.err;
    const Film expected = read_exr(folder_ / "all.exr"), film = read_exr(folder_ / "some.exr");
    for (const Plane& plane : expected.planes)
        EXPECT_EQ(film.find(plane.name)->values, plane.values) << plane.name;
    EXPECT_FALSE(statistics("all").contains("memory"));
    const nlohmann::json s = statistics("some");
    const nlohmann::json& memory = s.at("memory");
    EXPECT_EQ(memory.at("budget_bytes"), 1310720);
    EXPECT_LE(memory.at("peak_bytes"), memory.at("budget_bytes"));
    EXPECT_GT(memory.at("drops"), 0);
    EXPECT_GT(memory.at("regenerated_share").at("blocks"), 0);
    EXPECT_LT(memory.at("regenerated_share").at("blocks"), 1);
    EXPECT_EQ(memory.at("made").at("blocks"), s.at("counters").at("blocks_made"));
    EXPECT_GE(s.at("left_out").at("patches_never_opened"), 0);
    // One line a frame says so.
    const Outcome sequence = razor("render" + rest + "--frames 0:1 -o %d.exr --memory 1.25MiB");
    ASSERT_EQ(sequence.code, 0) << sequence.err;
    EXPECT_NE(sequence.out.find("at most 1."), std::string::npos) << sequence.out;
    EXPECT_NE(sequence.out.find("of nodes made again"), std::string::npos) << sequence.out;
    for (const char* name : {"0.exr", "1.exr"})
        for (const Plane& plane : expected.planes)
            EXPECT_EQ(read_exr(folder_ / name).find(plane.name)->values, plane.values) << plane.name;
}

// All but the topology's pages is built anew for each frame, and the picture stays.
TEST_F(Razor, LaterFramesFindTheTopologyAnalysed) {
    const std::string rest = " --size 20x10 --spp 1 --threads 1 ";
    ASSERT_EQ(razor("render" + rest + "-o once.exr --stats once.json").code, 0);
    const Outcome thrice = razor("render" + rest + "-o thrice.exr --stats thrice.json --repeat 3");
    ASSERT_EQ(thrice.code, 0) << thrice.err;
    const Film expected = read_exr(folder_ / "once.exr"), film = read_exr(folder_ / "thrice.exr");
    for (const Plane& plane : expected.planes)
        EXPECT_EQ(film.find(plane.name)->values, plane.values) << plane.name;
    const nlohmann::json once = statistics("once"), last = statistics("thrice");
    for (const auto& [name, value] : once.at("counters").items())
        EXPECT_EQ(last.at("counters").at(name), name == "pages_requested" ? nlohmann::json(0) : value)
            << name;
    for (const char* name : {"built", "opened", "left_out"})
        EXPECT_EQ(last.at(name), once.at(name)) << name;
    EXPECT_GT(once.at("counters").at("pages_requested"), 0);
    const nlohmann::json& frames = last.at("host").at("frames");
    ASSERT_EQ(frames.size(), 3U);
    for (std::size_t n = 0; n < 3; ++n) {
        EXPECT_GT(frames[n].at("render_seconds"), 0) << n;
        EXPECT_EQ(frames[n].at("topology_page_seconds") > 0, n == 0) << n;
    }
}

TEST_F(Razor, WritesPicturesAndStatistics) {
    const Outcome result =
        razor("render good.toml --size 20x10 --spp 1 -o a.exr -o b.png --stats s.json --threads 2 --share 2");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out + result.err, "");
    ImageAttributes attributes;
    const Film film = read_exr(folder_ / "a.exr", &attributes);
    EXPECT_EQ(film.width, 20);
    EXPECT_EQ(film.height, 10);
    for (const Plane& plane : make_film(1, 1).planes) {
        EXPECT_NE(film.find(plane.name), nullptr) << plane.name;
    }
    EXPECT_TRUE(std::filesystem::exists(folder_ / "b.png"));
    EXPECT_EQ(razor("render good.instances --size 20x10 --spp 1 -o i.exr").code, 0);
    EXPECT_EQ(read_exr(folder_ / "i.exr").width, 20);
    std::ifstream file(folder_ / "s.json");
    const nlohmann::json statistics = nlohmann::json::parse(file);
    EXPECT_EQ(statistics.at("options").at("threads"), 2);
    EXPECT_EQ(statistics.at("options").at("workers_a_tree"), 2);
    EXPECT_EQ(statistics.at("options").at("eager"), false);
    // The embedded scene is what --print-config prints, and renders again.
    const auto embedded = std::find_if(attributes.begin(), attributes.end(),
                                       [](const auto& a) { return a.first == "razor.scene"; });
    ASSERT_NE(embedded, attributes.end());
    EXPECT_EQ(embedded->second, statistics.at("scene"));
    const Outcome printed = razor("render good.toml --size 20x10 --spp 1 --print-config");
    EXPECT_EQ(printed.out, embedded->second);
    folder_.file("again.toml", printed.out);
    EXPECT_EQ(razor("render again.toml -o c.exr").code, 0);
    const Film again = read_exr(folder_ / "c.exr");
    for (const Plane& plane : film.planes) {
        EXPECT_EQ(again.find(plane.name)->values, plane.values) << plane.name;
    }
}

/// Nothing is written over what it is made of, nor two things to one file.
TEST_F(Razor, OutputsAreNoInputs) {
    const std::string model = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const std::string scene = "name = \"s\"\n[[mesh]]\nname = \"m\"\nfile = \"m.obj\"\n";
    folder_.file("m.obj", model);
    folder_.file("s.toml", scene);
    ASSERT_EQ(razor("render s.toml --size 8x8 --spp 1 -o a.exr").code, 0);
    std::filesystem::create_symlink("s.toml", folder_ / "link.toml");
    const auto text = [&](const char* name) {
        std::ifstream file(folder_ / name);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const auto refused = [&](const std::string& arguments, const char* why) {
        expect_refused(arguments, why);
        EXPECT_EQ(text("m.obj"), model) << arguments;
        EXPECT_EQ(text("s.toml"), scene) << arguments;
    };
    const std::string render = "render s.toml --size 8x8 --spp 1 ";
    for (const char* file : {"s.toml", "./s.toml", "link.toml", "m.obj"}) {
        refused(render + "-o b.exr --stats " + file, "made of");
        refused(render + "-o b.exr --trace " + file, "made of");
        refused(std::string("info s.toml --json ") + file, "made of");
        refused(std::string("check s.toml --size 8x8 --json ") + file, "made of");
    }
    refused("export-mesh m.obj -o m.obj --size 8x8", "made of");
    refused(render + "-o b.exr --stats b.exr", "two outputs");
    refused(render + "-o b.exr -o ./b.exr", "two outputs");
    refused(render + "-o b.exr --trace b.exr", "two outputs");
    refused("compare a.exr a.exr --json a.exr", "one of the pictures compared");
}

/// Names of files are any bytes, those in reports and scene files are not.
TEST_F(Razor, NamesMayBeNoUtf8) {
    folder_.file("m\xe9.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string render = "render 'm\xe9.obj' --size 8x8 --spp 1 ";
    EXPECT_EQ(razor(render + "--stats s.json -o i.exr").code, 0);
    std::ifstream file(folder_ / "s.json");
    EXPECT_NE(nlohmann::json::parse(file).at("scene").get<std::string>().find("\xef\xbf\xbd.obj"),
              std::string::npos); // replaced
    EXPECT_EQ(razor("info 'm\xe9.obj' --json s.json").code, 0);
    EXPECT_EQ(razor("check 'm\xe9.obj' --json s.json").code, 0);
    const Outcome config = razor(render + "--print-config");
    EXPECT_EQ(config.code, 2);
    EXPECT_EQ(config.out, "");
    EXPECT_EQ(config.error_lines(), 1);
    EXPECT_NE(config.err.find("m\\xe9"), std::string::npos) << config.err;
}

TEST_F(Razor, FailedWritingLeavesNothing) {
    // ulimit counts blocks of 512 or 1024 bytes; the picture needs more than four of either.
    const std::size_t before = folder_.count();
    const Outcome result = run("ulimit -f 4; trap '' XFSZ; " + quoted_argument(RAZOR_PROGRAM) +
                                   " render --size 200x200 --spp 1 --edge-pixels 50 -o big.exr",
                               folder_.path());
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_EQ(result.error_lines(), 1) << result.err;
    EXPECT_EQ(folder_.count(), before);
}

TEST_F(Razor, InterruptLeavesNothing) {
    const std::size_t before = folder_.count();
    const Outcome result =
        run("timeout --foreground --preserve-status -s INT 1 " + quoted_argument(RAZOR_PROGRAM) +
                " render --size 3000x3000 --spp 16 -o a.exr",
            folder_.path());
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_EQ(result.err, "razor: interrupted; nothing written\n");
    EXPECT_EQ(folder_.count(), before);
}

TEST_F(Razor, SaysItsVersion) {
    const Outcome result = razor("--version");
    EXPECT_EQ(result.code, 0);
    EXPECT_TRUE(result.out.starts_with("razor 0.")) << result.out;
    EXPECT_EQ(razor("--help").code, 0);
    EXPECT_EQ(razor("render --help").code, 0);
}

} // namespace
} // namespace razor
