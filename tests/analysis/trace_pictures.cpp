// Addresses over time against plain counts, pictures against those, and drawings that stand alone.
#include "analysis/images/image_file.h"
#include "analysis/plots/chart.h"
#include "analysis/plots/overlay.h"
#include "analysis/plots/page.h"
#include "analysis/plots/png.h"
#include "analysis/plots/table_chart.h"
#include "analysis/traces/address_picture.h"
#include "traces/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <tuple>
#include <unistd.h>

namespace analysis {
namespace {

struct Referenced {
    std::vector<Access> all;
    std::uint64_t first = 0;
};
Referenced random_references(std::size_t count, std::uint64_t span, std::uint32_t seed) {
    std::mt19937_64 random(seed);
    Referenced out;
    std::uint64_t time = out.first = 1000000;
    for (std::size_t i = 0; i < count; ++i) {
        Access a{};
        a.time = time;
        time += random() % span;
        a.group = static_cast<std::uint32_t>(random() % 3);
        a.address =
            (std::uint64_t{a.group} << 40U) + (random() % 50) * (random() % 50) * 4096 + random() % 64;
        out.all.push_back(a);
    }
    return out;
}

/// However pages and columns were merged, counts are those of the pages and columns that there are at the
/// end.
TEST(AddressTime, HasTheCountsOfAPlainTable) {
    for (const auto& [span, columns, rows] :
         {std::tuple<std::uint64_t, std::size_t, std::size_t>{2, 64, 4096},
          {1000, 16, 20},
          {100000, 128, 300},
          {1, 2048, 7}}) {
        const Referenced references = random_references(20000, span, static_cast<std::uint32_t>(span));
        AddressTime counts(columns, rows);
        for (const Access& a : references.all)
            counts.add(a);
        EXPECT_LE(counts.columns(), columns);
        EXPECT_LE(counts.rows().size(), rows);
        EXPECT_GT(counts.columns(), span == 1 ? 0U : columns / 4);
        EXPECT_EQ(counts.begin(), references.first);
        std::map<std::tuple<std::uint32_t, std::uint64_t, std::size_t>, std::uint64_t> expected, got;
        for (const Access& a : references.all)
            ++expected[{a.group, a.address / counts.page_bytes() * counts.page_bytes(),
                        (a.time - references.first) / counts.column_length()}];
        std::uint64_t sum = 0;
        for (const AddressTime::Row& row : counts.rows())
            for (std::size_t c = 0; c < row.counts->size(); ++c)
                if ((*row.counts)[c] != 0) {
                    got[{row.group, row.address, c}] = (*row.counts)[c];
                    sum += (*row.counts)[c];
                }
        EXPECT_EQ(got, expected);
        EXPECT_EQ(sum, references.all.size());
    }
}

/// Pages of a group can become one, groups cannot.
TEST(AddressTime, SaysThatGroupsAreTooMany) {
    AddressTime counts(16, 64);
    for (std::uint32_t n = 0; n < 6400; ++n)
        counts.add({n * 4096, 0, n % 64, 0, n, false});
    EXPECT_LE(counts.rows().size(), 64U);
    try {
        counts.add({0, 0, 64, 0, 6400, false});
        FAIL();
    } catch (const traces::Error& e) {
        EXPECT_NE(std::string(e.what()).find("more than 64 groups"), std::string::npos) << e.what();
    }
}

/// A pixel is white exactly where nothing is referenced, and the darker the more is.
TEST(AddressPicture, IsDarkWhereReferencesAre) {
    AddressTime counts(64, 64);
    // Eight pages of group 0, touched one after the other, ever more often; one page of group 1, now and
    // then.
    for (std::uint64_t page = 0; page < 8; ++page)
        for (std::uint64_t i = 0; i < std::uint64_t{1} << (2 * page); ++i)
            counts.add({page * 4096, 0, 0, 0, page, false});
    counts.add({1 << 30, 0, 1, 0, 7, false});
    const AddressPicture picture = draw(counts, 64, 64);
    ASSERT_EQ(picture.bands.size(), 2U);
    EXPECT_EQ(picture.bands[0].group, 0U); // that with most references first
    EXPECT_EQ(picture.bands[0].pages, 8U);
    EXPECT_EQ(picture.bands[0].high, 7U * 4096);
    EXPECT_EQ(picture.most, 1U << 14U);
    ASSERT_EQ(picture.pixels.width, 8U);
    double before = 256 * 3;
    for (std::size_t page = 0; page < 8; ++page) {
        const std::size_t y = picture.bands[0].top + picture.bands[0].height - 1 - page; // upwards
        for (std::size_t x = 0; x < 8; ++x) {
            const std::uint8_t* rgb = &picture.pixels.rgb[3 * (y * 8 + x)];
            const double light = rgb[0] + rgb[1] + rgb[2];
            EXPECT_EQ(light == 255 * 3, x != page) << x << ' ' << page;
            if (x == page) {
                EXPECT_LT(light, before);
                before = light;
            }
        }
    }
    const std::string svg = with_legend(picture, counts, {"kd nodes", "<&\">"}, "cycles");
    EXPECT_NE(svg.find("kd nodes"), std::string::npos);
    EXPECT_NE(svg.find("&lt;&amp;&quot;&gt;"), std::string::npos);
    EXPECT_NE(svg.find("data:image/png;base64,iVBOR"), std::string::npos);
}

TEST(AddressPicture, HoldsFewBandsAndMany) {
    for (const std::uint32_t groups : {1U, 7U, 200U}) {
        AddressTime counts;
        for (std::uint32_t g = 0; g < groups; ++g)
            for (std::uint64_t i = 0; i < 30; ++i)
                counts.add({g * 100000 + i * 999, 0, g, 0, i * 100, false});
        const AddressPicture picture = draw(counts, 256, 128);
        EXPECT_EQ(picture.bands.size(), groups);
        EXPECT_EQ(picture.pixels.rgb.size(), 3 * picture.pixels.width * picture.pixels.height);
        EXPECT_LE(picture.pixels.width, 256U);
        for (const AddressPicture::Band& band : picture.bands)
            EXPECT_LE(band.top + band.height, picture.pixels.height);
        if (groups < 20) {
            EXPECT_LE(picture.pixels.height, 128U + groups * 5);
        }
    }
}

TEST(Png, ComesBackAsItWas) {
    Pixels pixels{3, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 128, 128, 128, 255, 255, 255}};
    const std::string bytes = png_bytes(pixels);
    EXPECT_EQ(bytes, png_bytes(pixels));
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("razor_png_" + std::to_string(getpid()) + ".png");
    {
        std::ofstream out(file, std::ios::binary);
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    const auto image = read_image(file);
    std::filesystem::remove(file);
    ASSERT_EQ(image.width, 3);
    ASSERT_EQ(image.height, 2);
    constexpr const char* channels[] = {"R", "G", "B"};
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(image.find(channels[c])->bits[i], pixels.rgb[3 * i + c]) << i << ' ' << channels[c];
    EXPECT_THROW(png_bytes({}), std::runtime_error);
    EXPECT_EQ(data_uri("M"), "data:image/png;base64,TQ==");
    EXPECT_EQ(data_uri("Ma"), "data:image/png;base64,TWE=");
    EXPECT_EQ(data_uri("Man"), "data:image/png;base64,TWFu");
}

/// The hotter a value, the redder and the less blue its pixel; grey where there is none.
TEST(Overlay, TintsByValues) {
    LinearImage picture(5, 1);
    for (auto& plane : picture.planes)
        plane = {0.5F, 0.5F, 0.5F, 0.5F, std::nanf("")};
    const std::vector<double> values = {0, 1, 1000, 1e6, 1e6};
    const OverlayScale logarithmic = scale_of(values, true);
    EXPECT_EQ(logarithmic.low, 1);
    EXPECT_EQ(logarithmic.high, 1e6);
    const Pixels pixels = overlaid(picture, values, logarithmic);
    ASSERT_EQ(pixels.rgb.size(), 15U);
    const auto at = [&](std::size_t i, std::size_t c) { return int{pixels.rgb[3 * i + c]}; };
    EXPECT_EQ(at(0, 0), 188); // 0.5 in sRGB
    EXPECT_TRUE(at(0, 0) == at(0, 1) && at(0, 1) == at(0, 2));
    EXPECT_TRUE(at(1, 2) > at(1, 0) && at(1, 2) > at(1, 1)); // blue
    EXPECT_TRUE(at(2, 1) > at(2, 0) && at(2, 1) > at(2, 2)); // green: in the middle of the logarithms
    EXPECT_TRUE(at(3, 0) > at(3, 1) && at(3, 0) > at(3, 2)); // red
    EXPECT_LT(at(4, 0), at(3, 0));                           // the picture below is seen
    const OverlayScale linear = scale_of(values, false);
    EXPECT_EQ(linear.low, 0);
    const Pixels by_value = overlaid(picture, values, linear);
    EXPECT_GT(by_value.rgb[3 * 2 + 2], by_value.rgb[3 * 2]); // a thousandth of the most is cold
    EXPECT_NE(overlay_svg(pixels, logarithmic, "bytes.touched").find("bytes.touched, logarithmic"),
              std::string::npos);
    EXPECT_EQ(scale_of({}, true).low, 1);
}

TEST(Chart, PutsValuesWhereTheirAxesSay) {
    LineChart chart;
    chart.x = {"size", Unit::bytes, true};
    chart.y = {"part", Unit::percent, false};
    chart.series.push_back({"a & b", {{64, 0.8}, {128, 0.4}, {256, 0}}, {}, false});
    const std::string svg = chart.svg();
    EXPECT_EQ(svg, chart.svg());
    EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
    EXPECT_NE(svg.find(">128 B<"), std::string::npos);
    // From 70 to 670 to the right; 294 is the axis, 14 the top, which stands for 0.8 * 1.05.
    EXPECT_NE(svg.find("70,27.33 370,160.67 670,294"), std::string::npos) << svg;
}

/// Names that are too long end behind a whole character, whatever number of bytes it has.
TEST(Chart, CutsNamesBetweenCharacters) {
    for (const std::size_t before : {20U, 21U, 22U, 23U, 24U}) {
        const std::string name = std::string(before, 'a') + "\u4e2d\u00e9\U0001f600 and more than fits";
        LineChart lines;
        lines.series.push_back({name, {{0, 1}}, {}, false});
        BarChart bars;
        bars.bars.push_back({std::string(4, 'b') + name, {1}});
        bars.parts = {name, "other"};
        for (const std::string& svg : {lines.svg(), bars.svg()}) {
            const std::size_t end = svg.find("...</text>");
            ASSERT_NE(end, std::string::npos);
            std::size_t at = svg.rfind('>', end) + 1;
            for (std::size_t left = 0; at <= end; ++at) { // of the bytes of a character
                const unsigned c = static_cast<unsigned char>(svg[at]);
                ASSERT_EQ((c & 0xC0U) == 0x80U, left > 0) << svg;
                left = left > 0 ? left - 1 : c >= 0xF0U ? 3 : c >= 0xE0U ? 2 : c >= 0xC0U ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(cut("caf\u00e9s!!", 8), "caf\u00e9s!!"); // eight bytes
    EXPECT_EQ(cut("caf\u00e9s!!", 7), "caf...");
}

/// As many lines as there are names and columns, as many bars as rows, and where numbers say.
TEST(TableChart, DrawsWhatTheTableSays) {
    Table table{{"structure", "bytes", "misses", "ratio"}, {}};
    for (const char* name : {"nodes", "grids"})
        for (const std::uint64_t bytes : {1024U, 2048U})
            table.rows.push_back(
                {std::string(name), bytes, std::uint64_t{4096} / bytes, 512.0 / static_cast<double>(bytes)});
    const auto count = [](const std::string& text, const std::string& what) {
        std::size_t n = 0;
        for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
            ++n;
        return n;
    };
    const std::string lines =
        lines_of(table, 1, "bytes", {"ratio"}, {"size", Unit::bytes, true}, {"part", Unit::percent});
    EXPECT_EQ(count(lines, "<polyline"), 2U);
    EXPECT_EQ(count(lines, "70,27.33 670,160.67"), 2U); // both fall from a half to a quarter
    EXPECT_EQ(count(lines_of(table, 1, "bytes", {"ratio", "misses"}, {}, {}), "<polyline"), 4U);
    const std::string bars = bars_of(table, 2, {"misses"}, {"misses"});
    EXPECT_EQ(count(bars, "<title>"), 4U);
    EXPECT_NE(bars.find("<title>grids, 2 KiB, misses: 2</title>"), std::string::npos);
    EXPECT_THROW(bars_of(table, 1, {"hits"}, {}), std::logic_error);
}

/// A header alone, of more pixels than so few bytes can hold: nothing of that size is allocated.
TEST(ImageFile, HoldsWhatItsBytesCan) {
    std::string bytes("\x76\x2f\x31\x01\x02\0\0\0", 8);
    const auto add = [&](const char* name, const char* type, const std::vector<std::int32_t>& words,
                         const std::string& before = "") {
        const auto size = static_cast<std::int32_t>(before.size() + 4 * words.size());
        bytes.append(name).append(1, '\0').append(type).append(1, '\0');
        bytes.append(reinterpret_cast<const char*>(&size), 4).append(before);
        for (const std::int32_t word : words)
            bytes.append(reinterpret_cast<const char*>(&word), 4);
    };
    using namespace std::string_literals;
    const std::int32_t one = std::bit_cast<std::int32_t>(1.0F);
    add("channels", "chlist", {}, "R\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0"s);
    add("compression", "compression", {}, "\3"s);
    add("dataWindow", "box2i", {0, 0, 39999, 39999});
    add("displayWindow", "box2i", {0, 0, 39999, 39999});
    add("lineOrder", "lineOrder", {}, "\0"s);
    add("pixelAspectRatio", "float", {one});
    add("screenWindowCenter", "v2f", {0, 0});
    add("screenWindowWidth", "float", {one});
    bytes.append(40000, '\0'); // the end of the header, and offsets of its lines
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("razor_large_" + std::to_string(getpid()) + ".exr");
    std::ofstream(file, std::ios::binary) << bytes;
    try {
        read_image(file);
        ADD_FAILURE();
    } catch (const ImageError& e) {
        EXPECT_NE(std::string(e.what()).find("40000 x 40000 pixels cannot be in"), std::string::npos)
            << e.what();
    }
    std::filesystem::remove(file);
}

TEST(Chart, HasTicksInItsRange) {
    for (const auto& [low, high] : {std::pair{0.0, 1.0}, {0.0, 3e9}, {1e6, 1.3e6}, {0.0, 0.0007}, {5.0, 5.0}})
        for (const Unit unit : {Unit::plain, Unit::bytes, Unit::percent}) {
            const std::vector<double> at = ticks(low, high, false, unit, 8);
            EXPECT_GE(at.size(), high > low ? 2U : 1U);
            EXPECT_LE(at.size(), 10U);
            for (const double t : at)
                EXPECT_TRUE(t >= low - 1e-9 && t <= high * (1 + 1e-9)) << t;
        }
    // Nanoseconds since 1970, whose neighbours are 256 apart.
    for (const double length : {256.0, 1000.0, 1e6, 1e12}) {
        const double low = 1.7e18, high = low + length;
        const std::vector<double> at = ticks(low, high, false, Unit::plain, 9);
        EXPECT_GE(at.size(), 1U) << length;
        EXPECT_LE(at.size(), 11U) << length;
        EXPECT_TRUE(std::is_sorted(at.begin(), at.end(), std::less_equal<>())) << "none twice";
        for (const double t : at)
            EXPECT_TRUE(t >= low * (1 - 1e-15) && t <= high * (1 + 1e-9)) << t;
    }
    EXPECT_EQ(ticks(64, 1024, true, Unit::bytes, 9), (std::vector<double>{64, 128, 256, 512, 1024}));
    EXPECT_EQ(short_text(65536, Unit::bytes), "64 KiB");
    EXPECT_EQ(short_text(1.5e6, Unit::plain), "1.5 M");
    EXPECT_EQ(short_text(0.25, Unit::percent), "25 %");
}

TEST(Page, StandsAlone) {
    Page page("<trace>");
    page.heading("a & b");
    page.paragraph("words");
    Table table{{"name", "count"}, {}};
    table.rows.push_back({std::string("x<y"), std::uint64_t{7}});
    page.table("all", table);
    BarChart bars;
    bars.x.label = "misses";
    bars.parts = {"one", "two"};
    bars.bars.push_back({"first", {1, 2}});
    page.drawing(bars.svg());
    const std::string html = page.html();
    EXPECT_NE(html.find("<title>&lt;trace&gt;</title>"), std::string::npos);
    EXPECT_NE(html.find("<td>x&lt;y</td><td class=\"number\">7</td>"), std::string::npos);
    EXPECT_NE(html.find("<svg"), std::string::npos);
    // Nothing is fetched: addresses are names of namespaces alone.
    for (std::size_t at = html.find("http"); at != std::string::npos; at = html.find("http", at + 1))
        EXPECT_EQ(html.substr(at, 18), "http://www.w3.org/");
    EXPECT_EQ(html.find("<script"), std::string::npos);
}

} // namespace
} // namespace analysis
