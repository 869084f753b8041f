// razor-image-compare: what is identical, what differs and where, and pictures that cannot be read.
#include "razor/image/exr.h"
#include "razor/image/png.h"
#include "tests/program/run.h"

#include <bit>
#include <cmath>

namespace razor {
namespace {

Outcome compare(const TemporaryFolder& folder, const std::string& a, const std::string& b) {
    return run(std::string(RAZOR_IMAGE_COMPARE) + " " + quoted_argument(a) + " " + quoted_argument(b),
               folder.path());
}

Film grey() {
    Film film = make_film(5, 4);
    for (Plane& plane : film.planes) {
        std::fill(plane.values.begin(), plane.values.end(), 0.5F);
    }
    return film;
}

TEST(ImageCompare, SaysIdentical) {
    const TemporaryFolder folder;
    Film film = grey();
    film.find("G")->values[3] = std::bit_cast<float>(0x7fc00001U); // equal NaNs are identical
    write_exr(folder / "a.exr", film, {{"note", "one"}});
    write_exr(folder / "b.exr", film, {{"note", "another"}});
    write_png(folder / "a.png", film);
    write_png(folder / "b.png", film);
    const Outcome exr = compare(folder, "a.exr", "b.exr");
    EXPECT_EQ(exr.code, 0);
    EXPECT_EQ(exr.out, "identical: 5 x 4, 10 planes\n");
    EXPECT_EQ(compare(folder, "a.png", "b.png").out, "identical: 5 x 4, 3 planes\n");
}

TEST(ImageCompare, FindsEveryDifference) {
    const TemporaryFolder folder;
    Film film = grey();
    write_exr(folder / "a.exr", film);
    write_png(folder / "a.png", film);
    film.find("albedo.G")->values[13] = std::nextafter(0.5F, 1.0F); // (3, 2), one last bit
    film.find("albedo.G")->values[16] = 0.75F;                      // (1, 3)
    film.find("R")->values[7] = 0.6F;
    write_exr(folder / "b.exr", film);
    write_png(folder / "b.png", film);
    const Outcome exr = compare(folder, "a.exr", "b.exr");
    EXPECT_EQ(exr.code, 1);
    EXPECT_NE(exr.out.find("albedo.G: 2 of 20 pixels differ, first at (3, 2); largest difference 0.25 at (1, "
                           "3): 0.5 and 0.75"),
              std::string::npos)
        << exr.out;
    EXPECT_EQ(std::count(exr.out.begin(), exr.out.end(), '\n'), 2);
    EXPECT_EQ(compare(folder, "a.png", "b.png").code, 1);

    Film zero = grey(), minus = grey(), broken = grey();
    zero.find("B")->values[0] = 0.0F;
    minus.find("B")->values[0] = -0.0F;
    broken.find("B")->values[0] = std::bit_cast<float>(0x7fc00000U);
    write_exr(folder / "z.exr", zero);
    write_exr(folder / "m.exr", minus);
    write_exr(folder / "n.exr", broken);
    EXPECT_EQ(compare(folder, "z.exr", "m.exr").code, 1);
    EXPECT_NE(compare(folder, "z.exr", "n.exr").out.find("largest difference nan"), std::string::npos);

    Film fewer = grey();
    fewer.planes.pop_back();
    write_exr(folder / "f.exr", fewer);
    EXPECT_EQ(compare(folder, "a.exr", "f.exr").out, "albedo.B: only in the first picture\n");
    EXPECT_EQ(compare(folder, "f.exr", "a.exr").out, "albedo.B: only in the second picture\n");
    write_exr(folder / "w.exr", make_film(4, 5));
    EXPECT_EQ(compare(folder, "a.exr", "w.exr").code, 1);
    EXPECT_EQ(compare(folder, "a.exr", "a.png").code, 1);
}

TEST(ImageCompare, RefusesWhatIsNoPicture) {
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", grey());
    folder.file("random.exr", "\x01\x02random");
    folder.file("cut.exr", "\x76\x2f\x31\x01 cut");
    folder.file("cut.png", "\x89PNG\r\n\x1a\ncut");
    folder.file("empty.png", "");
    for (const char* bad : {"none.exr", ".", "random.exr", "cut.exr", "cut.png", "empty.png"}) {
        for (const Outcome& result : {compare(folder, "a.exr", bad), compare(folder, bad, "a.exr")}) {
            EXPECT_EQ(result.code, 2) << bad;
            EXPECT_EQ(result.error_lines(), 1) << result.err;
            EXPECT_EQ(result.out, "");
        }
    }
    EXPECT_EQ(run(RAZOR_IMAGE_COMPARE, folder.path()).code, 2);
}

} // namespace
} // namespace razor
