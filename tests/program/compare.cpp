// razor compare: figures, files, identical pictures, and pictures that cannot be compared.
#include "analysis/images/image_file.h"
#include "razor/image/exr.h"
#include "razor/image/png.h"
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace razor {
namespace {

/// A folder of pictures, for razor to run in.
class Compare : public ::testing::Test {
protected:
    static Film grey(float value = 0.5F) {
        Film film = make_film(5, 4);
        for (Plane& plane : film.planes) {
            std::fill(plane.values.begin(), plane.values.end(), value);
        }
        return film;
    }

    Outcome compare(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " compare " + arguments, folder_.path());
    }

    nlohmann::json figures(const std::string& arguments) const {
        const Outcome result = compare(arguments + " --json figures.json");
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        std::ifstream file(folder_ / "figures.json");
        return nlohmann::json::parse(file);
    }

    void expect_refused(const std::string& arguments, const std::string& cause) const {
        SCOPED_TRACE("razor compare " + arguments);
        const std::size_t before = folder_.count();
        const Outcome result = compare(arguments);
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(folder_.count(), before) << "a file was left";
    }

    TemporaryFolder folder_;
};

TEST_F(Compare, SaysIdentical) {
    Film film = grey();
    film.find("G")->values[3] = std::bit_cast<float>(0x7fc00001U); // equal NaNs are identical
    write_exr(folder_ / "a.exr", film, {{"note", "one"}});
    write_exr(folder_ / "b.exr", film, {{"note", "another"}});
    write_png(folder_ / "a.png", film);
    write_png(folder_ / "b.png", film);
    const Outcome exr = compare("--identical a.exr b.exr");
    EXPECT_EQ(exr.code, 0);
    EXPECT_EQ(exr.out, "identical: 5 x 4, 10 planes\n");
    EXPECT_EQ(compare("a.png b.png --identical").out, "identical: 5 x 4, 3 planes\n");
}

TEST_F(Compare, FindsEveryDifference) {
    Film film = grey();
    write_exr(folder_ / "a.exr", film);
    write_png(folder_ / "a.png", film);
    film.find("albedo.G")->values[13] = std::nextafter(0.5F, 1.0F); // (3, 2), one last bit
    film.find("albedo.G")->values[16] = 0.75F;                      // (1, 3)
    film.find("R")->values[7] = 0.6F;
    write_exr(folder_ / "b.exr", film);
    write_png(folder_ / "b.png", film);
    const Outcome exr = compare("--identical a.exr b.exr");
    EXPECT_EQ(exr.code, 1);
    EXPECT_NE(exr.out.find("albedo.G: 2 of 20 pixels differ, first at (3, 2); largest difference 0.25 at (1, "
                           "3): 0.5 and 0.75"),
              std::string::npos)
        << exr.out;
    EXPECT_EQ(std::count(exr.out.begin(), exr.out.end(), '\n'), 2);
    EXPECT_EQ(compare("--identical a.png b.png").code, 1);
    EXPECT_EQ(compare("a.png b.png").code, 0);

    Film zero = grey(), minus = grey(), broken = grey();
    zero.find("B")->values[0] = 0.0F;
    minus.find("B")->values[0] = -0.0F;
    broken.find("B")->values[0] = std::bit_cast<float>(0x7fc00000U);
    write_exr(folder_ / "z.exr", zero);
    write_exr(folder_ / "m.exr", minus);
    write_exr(folder_ / "n.exr", broken);
    EXPECT_EQ(compare("--identical z.exr m.exr").code, 1);
    EXPECT_NE(compare("--identical z.exr n.exr").out.find("1 of them NaN or infinite"), std::string::npos);

    Film fewer = grey();
    fewer.planes.pop_back();
    write_exr(folder_ / "f.exr", fewer);
    EXPECT_EQ(compare("--identical a.exr f.exr").out, "albedo.B: only in the first picture\n");
    EXPECT_EQ(compare("--identical f.exr a.exr").out, "albedo.B: only in the second picture\n");
    write_exr(folder_ / "w.exr", make_film(4, 5));
    EXPECT_EQ(compare("--identical a.exr w.exr").code, 1);
    EXPECT_EQ(compare("--identical a.exr a.png").code, 1);
}

TEST_F(Compare, MeasuresAgainstTheReference) {
    write_exr(folder_ / "a.exr", grey(0.75F));
    Film reference = grey(0.5F);
    reference.find("albedo.G")->values[16] = -2.25F;
    write_exr(folder_ / "b.exr", reference);
    const nlohmann::json report = figures("a.exr b.exr");
    EXPECT_EQ(report["picture"], "a.exr");
    EXPECT_EQ(report["reference"], "b.exr");
    EXPECT_EQ(report["identical"], false);
    EXPECT_EQ(report["pixels_differing"], 20);
    EXPECT_EQ(report["pixels_compared"], 20);
    EXPECT_EQ(report["rmse"], 0.25);
    EXPECT_NEAR(report["relative_mse"].get<double>(), 0.0625 / (0.51 * 0.51), 1e-12);
    EXPECT_NEAR(report["mape"].get<double>(), 0.25 / 0.51, 1e-12);
    EXPECT_EQ(report["largest_difference"]["value"], 0.25); // of colours only
    const nlohmann::json albedo = report["channels"][4];
    EXPECT_EQ(albedo["name"], "albedo.G");
    EXPECT_EQ(albedo["largest_difference"], 3);
    EXPECT_EQ(albedo["largest_at"]["x"], 1);
    EXPECT_EQ(albedo["largest_at"]["y"], 3);
    EXPECT_EQ(albedo["not_finite_pixels"], 0);
    EXPECT_EQ(report["flip"]["kind"], "HDR");
    // An even reference: both exposures bring its 0.5 to 0.85.
    EXPECT_EQ(report["flip"]["exposures"], 2);
    EXPECT_NEAR(report["flip"]["start_exposure"].get<double>(), report["flip"]["stop_exposure"].get<double>(),
                1e-9);
    EXPECT_GT(report["flip"]["mean"], 0.1);
    EXPECT_EQ(report["channels"].size(), 10U);

    const nlohmann::json none = figures("a.exr a.exr");
    EXPECT_EQ(none["identical"], true);
    EXPECT_EQ(none["largest_difference"], nullptr);
    for (const char* key : {"rmse", "relative_mse", "mape", "pixels_differing"}) {
        EXPECT_EQ(none[key], 0) << key;
    }
    EXPECT_EQ(none["flip"]["maximum"], 0);

    const nlohmann::json chosen =
        figures("a.exr b.exr --start-exposure -3 --stop-exposure 1.5 --tone-mapper hable "
                "--pixels-per-degree 30");
    EXPECT_EQ(chosen["flip"]["start_exposure"], -3);
    EXPECT_EQ(chosen["flip"]["stop_exposure"], 1.5);
    EXPECT_EQ(chosen["flip"]["exposures"], 5);
    EXPECT_EQ(chosen["flip"]["tone_mapper"], "hable");
    EXPECT_EQ(chosen["flip"]["pixels_per_degree"], 30);
    EXPECT_EQ(figures("a.exr b.exr --exposures 7")["flip"]["exposures"], 7);
}

TEST_F(Compare, MeasuresDisplayValues) {
    write_png(folder_ / "black.png", grey(0));
    write_png(folder_ / "white.png", grey(1));
    const nlohmann::json report = figures("white.png black.png -o map.png -o difference.exr");
    EXPECT_EQ(report["flip"]["kind"], "LDR");
    EXPECT_EQ(report["rmse"], 1);
    EXPECT_NEAR(report["mape"].get<double>(), 100, 1e-9);
    EXPECT_NEAR(report["flip"]["mean"].get<double>(), 0.967, 1e-3);
    EXPECT_EQ(report["largest_difference"]["value"], 255); // of stored values
    const Film difference = read_exr(folder_ / "difference.exr");
    EXPECT_EQ(difference.find("G")->values[7], 1); // of light
    EXPECT_NEAR(difference.find("FLIP")->values[7], 0.967, 1e-3);
}

TEST_F(Compare, WritesDifferences) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Film picture = grey(), reference = grey();
    picture.find("G")->values[6] = 0.25F;
    picture.find("R")->values[19] = NAN;
    picture.find("depth.Z")->values[0] = reference.find("depth.Z")->values[0] = infinity;
    picture.find("depth.Z")->values[1] = infinity;
    write_exr(folder_ / "a.exr", picture);
    write_exr(folder_ / "b.exr", reference);
    const nlohmann::json report = figures("a.exr b.exr -o difference.exr --output map.PNG");
    EXPECT_EQ(report["pixels_compared"], 19);
    EXPECT_EQ(report["pixels_left_out"], 1);
    EXPECT_EQ(report["not_finite"]["picture"]["nan_pixels"], 1);
    EXPECT_EQ(report["not_finite"]["reference"]["nan_pixels"], 0);
    EXPECT_NEAR(report["rmse"].get<double>(), 0.25 / std::sqrt(57.0), 1e-12);
    EXPECT_EQ(report["largest_difference"]["channel"], "G");
    EXPECT_EQ(report["largest_difference"]["x"], 1);
    EXPECT_EQ(report["largest_difference"]["y"], 1);
    EXPECT_EQ(report["largest_difference"]["picture"], 0.25);
    EXPECT_EQ(report["largest_difference"]["reference"], 0.5);
    const Film difference = read_exr(folder_ / "difference.exr");
    EXPECT_EQ(difference.find("G")->values[6], -0.25F); // signed: picture - reference
    EXPECT_EQ(difference.find("G")->values[5], 0);
    EXPECT_TRUE(std::isnan(difference.find("R")->values[19]));
    EXPECT_EQ(difference.find("depth.Z")->values[0], 0);
    EXPECT_EQ(difference.find("depth.Z")->values[1], infinity);
    EXPECT_TRUE(std::isnan(difference.find("FLIP")->values[19]));
    EXPECT_GT(difference.find("FLIP")->values[6], 0);
    const analysis::ImageFile map = analysis::read_image(folder_ / "map.PNG");
    const auto colour = [&](std::size_t pixel) {
        return std::array{map.find("R")->value(pixel), map.find("G")->value(pixel),
                          map.find("B")->value(pixel)};
    };
    EXPECT_EQ(colour(19), (std::array<double, 3>{0, 255, 0})); // no number
    EXPECT_GT(colour(6)[0], 30);                               // where they differ
    EXPECT_EQ(compare("a.exr a.exr -o none.png").code, 0);
    EXPECT_EQ(analysis::read_image(folder_ / "none.png").find("B")->value(6), 0); // black where they do not
    EXPECT_NE(compare("a.exr b.exr")
                  .out.find("1 of 20 pixels with NaN or infinity in R, G or B (picture: 1 with NaN"),
              std::string::npos);

    for (Plane& plane : picture.planes) {
        std::fill(plane.values.begin(), plane.values.end(), NAN);
    }
    write_exr(folder_ / "nothing.exr", picture);
    const nlohmann::json nothing = figures("nothing.exr b.exr");
    EXPECT_EQ(nothing["pixels_compared"], 0);
    EXPECT_EQ(nothing["rmse"], nullptr);
    EXPECT_EQ(nothing["flip"]["mean"], nullptr);
}

TEST_F(Compare, RefusesWhatIsNoPicture) {
    write_exr(folder_ / "a.exr", grey());
    folder_.file("random.exr", "\x01\x02random");
    folder_.file("cut.exr", "\x76\x2f\x31\x01 cut");
    folder_.file("cut.png", "\x89PNG\r\n\x1a\ncut");
    folder_.file("empty.png", "");
    for (const char* mode : {"", "--identical "}) {
        for (const std::string bad : {"none.exr", ".", "random.exr", "cut.exr", "cut.png", "empty.png"}) {
            expect_refused(mode + ("a.exr " + bad), bad + ": ");
            expect_refused(mode + (bad + " a.exr"), bad + ": ");
        }
    }
    expect_refused("a.exr none.exr", "none.exr: no such file");
    expect_refused("a.exr .", ".: is not a file");
    expect_refused("", "picture");
    expect_refused("a.exr", "reference");
    expect_refused("a.exr a.exr a.exr", "");
}

TEST_F(Compare, RefusesWhatCannotBeCompared) {
    write_exr(folder_ / "a.exr", grey());
    write_exr(folder_ / "b.exr", grey());
    write_png(folder_ / "a.png", grey());
    write_exr(folder_ / "wide.exr", make_film(7, 4));
    Film depth(5, 4);
    depth.add("Z");
    write_exr(folder_ / "depth.exr", depth);
    Film red(5, 4);
    red.add("R");
    write_exr(folder_ / "red.exr", red);
    std::filesystem::create_directory(folder_ / "folder.png");
    folder_.file("plain", "");

    const std::vector<std::pair<std::string, std::string>> cases{
        {"a.exr wide.exr", "a.exr has 5 x 4 pixels and wide.exr has 7 x 4"},
        {"a.exr depth.exr", "depth.exr: has no channel R"},
        {"depth.exr a.exr", "depth.exr: has no channel R"},
        {"red.exr red.exr", "red.exr: has no channel G"},
        {"a.exr a.png", "a.exr and a.png: one holds radiance"},
        {"a.png a.exr", "one holds radiance"},
        {"a.exr b.exr -o difference.jpg", "difference.jpg: cannot tell the picture's format"},
        {"a.exr b.exr -o none/difference.png", "no folder none"},
        {"a.exr b.exr -o folder.png", "folder.png: is a directory"},
        {"a.exr b.exr -o plain/difference.png", "no folder plain"},
        {"a.exr b.exr -o b.exr", "b.exr: is one of the pictures compared"},
        {"a.exr b.exr --json none/a.json", "no folder none"},
        {"a.exr b.exr --identical -o difference.png", "--identical"},
        {"a.exr b.exr --identical --json a.json", "--identical"},
        {"a.exr b.exr --tone-mapper film",
         "--tone-mapper 'film' is unknown; give one of: aces, hable, reinhard"},
        {"a.exr b.exr --pixels-per-degree 0", "--pixels-per-degree"},
        {"a.exr b.exr --pixels-per-degree nan", "--pixels-per-degree"},
        {"a.exr b.exr --exposures 0", "--exposures"},
        {"a.exr b.exr --start-exposure x", "--start-exposure"},
        {"a.exr b.exr --start-exposure 2 --stop-exposure 1",
         "the exposures start at 2.000 and stop at 1.000"},
        {"a.png a.png --tone-mapper aces", "for OpenEXR pictures"},
        {"a.exr b.exr --identcal", "did you mean --identical?"},
    };
    for (const auto& [arguments, cause] : cases) {
        expect_refused(arguments, cause);
    }
    EXPECT_EQ(compare("--identical depth.exr depth.exr").code, 0); // any channels will do
}

} // namespace
} // namespace razor
