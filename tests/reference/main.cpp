// razor-lod-reference: tables of what rays do to each way of choosing a level of detail.
#include "tests/reference/continuity.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <exception>

namespace razor::reference {
namespace {

std::vector<double> growths{-1, -0.1, 0, 0.01, 0.1, 0.4, 0.8, 1.6, 4, 10};
std::vector<double> footprints{0.5, 1, 4}; // in e0

std::string title(const Setting& s) {
    return fmt::format("{}, exponents {}, e0 {}, cap {}, morph in the last {} of an octave", s.scene,
                       s.random_exponents ? "random" : "by length", s.e0, s.cap, s.part);
}

void escapes(Setting setting, const std::vector<std::string>& schemes, int rays) {
    fmt::print("{}\n{:>10} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10}\n", title(setting), "scheme", "growth",
               "rays", "escapes", "uneven", "astray", "other", "open edges");
    setting.rays = std::max(rays / (setting.origins * static_cast<int>(footprints.size())), 1);
    for (const std::string& scheme : schemes)
        for (double growth : growths) {
            Counts sum;
            setting.growth = growth;
            for (double w0 : footprints) {
                setting.w0 = w0;
                sum.add(run(setting, {scheme}).schemes[scheme]);
            }
            fmt::print("{:>10} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10}\n", scheme, growth, sum.rays,
                       sum.escapes, sum.uneven, sum.astray, sum.other, sum.open);
        }
}

void blocks(Setting setting) {
    fmt::print("{}, blocks of {} x {} quads\n{:>7} {:>9} {:>9} {:>10} {:>8} {:>8} {:>12}\n", title(setting),
               setting.side, setting.side, "growth", "visited", "drawn", "morphing", "levels", "deepest",
               "triangles");
    setting.rays = 0;
    for (double growth : growths) {
        BlockCounts sum;
        setting.growth = growth;
        for (double w0 : footprints) {
            setting.w0 = w0;
            sum.add(run(setting, {}).blocks);
        }
        auto share = [](long a, long b) {
            return b == 0 ? 0.0 : static_cast<double>(a) / static_cast<double>(b);
        };
        fmt::print("{:>7} {:>9.1f} {:>9.1f} {:>9.1f}% {:>8.2f} {:>8} {:>11.1f}%\n", growth,
                   share(sum.visited, sum.origins), share(sum.drawn, sum.origins),
                   100 * share(sum.morphing, sum.drawn), share(sum.levels, sum.morphing), sum.deepest,
                   100 * share(sum.triangles, sum.finest));
    }
}

void continuity(Setting setting, const std::vector<std::string>& schemes) {
    fmt::print("{}\n{:>10} {:>7} {:>8} {:>8} {:>8}\n", title(setting), "scheme", "growth", "steps", "pops",
               "folds");
    setting.origins = 2;
    setting.rays = 24;
    for (const std::string& scheme : schemes)
        for (double growth : growths) {
            setting.growth = growth;
            Jumps j = jumps(setting, scheme, 6, 16);
            fmt::print("{:>10} {:>7} {:>8} {:>8} {:>8}\n", scheme, growth, j.steps, j.pops, j.folds);
        }
}

int main_(int argc, char** argv) {
    CLI::App app{
        "What rays from inside closed meshes do to each way of choosing a level of detail.\n"
        "escapes: nothing was hit; uneven: the number of crossings has the wrong parity;\n"
        "astray: the hit is over four target edges from the recursive surface's; other: it is another\n"
        "hit at all; open edges: edges of the surface with an odd number of triangles.\n"
        "Of blocks, a ray origin: visited; drawn; the share that needs coarser levels, of how many on\n"
        "average, and at most; triangles drawn of the finest.\n"
        "Of continuity: pops are jumps with as many crossings before as after, folds others."};
    std::string table = "escapes";
    std::vector<std::string> scenes = case_names();
    std::vector<std::string> schemes = scheme_names();
    Setting setting;
    int rays = 4800;
    double cap = 0;
    app.add_option("--table", table, "escapes, blocks or continuity")
        ->check(CLI::IsMember({"escapes", "blocks", "continuity"}));
    app.add_option("--case", scenes, "sphere, torus, ball, prism, relief, limit")
        ->check(CLI::IsMember(case_names()));
    app.add_option("--scheme", schemes, "schemes of the tables of escapes and continuity")
        ->check(CLI::IsMember(scheme_names()));
    app.add_option("--rays", rays, "of each scheme and growth")->check(CLI::Range(1, 100'000'000));
    app.add_option("--growth", growths, "of the footprint along a ray");
    app.add_option("--footprint", footprints, "at the origin, in target edges of level 0")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--origins", setting.origins, "of rays; a quarter of them outside")
        ->check(CLI::Range(1, 100'000));
    app.add_option("--seed", setting.seed);
    app.add_option("--edge", setting.e0, "target edge of level 0")->check(CLI::Range(0.001, 10.0));
    app.add_option("--largest", setting.largest, "exponent of an edge")->check(CLI::Range(0, 8));
    app.add_flag("--random", setting.random_exponents, "exponents of edges, rather than by length");
    app.add_flag("!--random-rays", setting.aimed, "no rays aimed at vertices and edges");
    app.add_option("--cap", cap, "of growth (gradation cap)")->check(CLI::PositiveNumber);
    app.add_option("--part", setting.part, "of an octave that morphs")->check(CLI::Range(0.001, 1.0));
    app.add_option("--side", setting.side, "quads along a block")->check(CLI::IsMember({1, 2, 4, 8, 16}));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (cap > 0)
        setting.cap = cap;
    for (const std::string& scene : scenes) {
        setting.scene = scene;
        if (table == "escapes")
            escapes(setting, schemes, rays);
        else if (table == "blocks")
            blocks(setting);
        else
            continuity(setting, schemes);
    }
    return 0;
}

} // namespace
} // namespace razor::reference

int main(int argc, char** argv) {
    try {
        return razor::reference::main_(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "razor-lod-reference: {}\n", error.what());
        return 2;
    }
}
