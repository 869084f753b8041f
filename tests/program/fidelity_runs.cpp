// razor-sim run --fidelity auto: errors beside whole runs in the reference mode, ways by machine and by
// error, mistakes.
#include "tests/program/simulator.h"

#include <cmath>
#include <filesystem>

namespace razor {
namespace {

class Fidelity : public Simulator {
protected:
    Fidelity() {
        folder_.file("box.toml", "[[mesh]]\nshape = \"box\"\n");
        folder_.file("urchin.toml", "[[mesh]]\nshape = \"urchin\"\n");
    }
    std::string frame(const std::string& scene, const std::string& machine,
                      const char* size = "48x48") const {
        return "run --quiet --no-native --no-calibration --spp 1 --light-samples 1 --edge-pixels 2 --scene " +
               scene + ".toml --size " + size + " --machine " +
               quoted_argument(RAZOR_SOURCE_DIR "/configs/machines/" + machine + ".toml") + " ";
    }
    nlohmann::json reported(const std::string& arguments) {
        const Outcome result = simulator(arguments + " --json out.json");
        EXPECT_EQ(result.code, 0) << arguments << ": " << result.err;
        return report("out.json");
    }
    static double bytes(const nlohmann::json& r) {
        return r.at("memory").at("reads").get<double>() + r.at("memory").at("writes").get<double>();
    }
    /// The place of the chosen way among all.
    static std::size_t chosen(const nlohmann::json& r) {
        const nlohmann::json& ways = r.at("fidelity").at("ways");
        for (std::size_t i = 0; i < ways.size(); ++i)
            if (ways[i].at("state") == "chosen")
                return i;
        ADD_FAILURE() << "nothing was chosen";
        return 0;
    }
};

constexpr const char* whole = "-g sim.mode=reference -g memory.controller=queued ";

TEST_F(Fidelity, MeetsItsErrorBesideTheWholeRun) {
    for (const char* scene : {"box", "urchin"})
        for (const char* machine : {"tiny", "study"}) {
            SCOPED_TRACE(std::string(scene) + " on " + machine);
            const nlohmann::json truth = reported(frame(scene, machine) + whole);
            std::size_t before = 0;
            for (const double wanted : {0.3, 0.1, 0.04, 0.01, 0.0}) {
                SCOPED_TRACE(wanted);
                const nlohmann::json r =
                    reported(frame(scene, machine) + "--fidelity auto --error " + std::to_string(wanted));
                const nlohmann::json& f = r.at("fidelity");
                EXPECT_EQ(f.at("wanted_error"), wanted);
                EXPECT_LE(f.at("error").at("cycles"), wanted);
                EXPECT_LE(f.at("error").at("dram_bytes"), wanted);
                // An interval of 95 % is missed now and then, but not by much.
                EXPECT_LE(std::abs(r.at("cycles").get<double>() / truth.at("cycles").get<double>() - 1),
                          1.5 * wanted);
                EXPECT_LE(std::abs(bytes(r) / bytes(truth) - 1), 1.5 * wanted);
                EXPECT_GE(chosen(r), before) << "a cheaper way for less error";
                before = chosen(r);
                EXPECT_EQ(f.at("ways")[chosen(r)].at("way"), f.at("chosen"));
            }
        }
}

// 0 is a run in the reference mode, digit for digit.
TEST_F(Fidelity, ZeroIsTheReferenceMode) {
    nlohmann::json r = reported(frame("box", "tiny") + "--fidelity auto --error 0");
    nlohmann::json truth = reported(frame("box", "tiny") + whole);
    for (const char* key : {"fidelity", "options", "machine_provenance"}) {
        r.erase(key);
        truth.erase(key);
    }
    EXPECT_EQ(r, truth);
}

// A seed that is there is cheapest where its errors will do; none is made.
TEST_F(Fidelity, TakesAKeptSeed) {
    const std::string run =
        frame("urchin", "tiny") + "-g chip.tiles=2 -g kdtree.share=tile --seed-report seed.json ";
    EXPECT_EQ(reported(run + "--fidelity auto --error 0.5").at("fidelity").at("ways")[0].at("state"),
              "not possible");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "seed.json"));
    const nlohmann::json computed = reported(run + "--estimate closed-form");
    const nlohmann::json r = reported(run + "--fidelity auto --error 0.5");
    EXPECT_EQ(r.at("fidelity").at("chosen"), "closed form");
    EXPECT_EQ(r.at("cycles"), computed.at("cycles"));
    EXPECT_EQ(r.at("fidelity").at("error").at("dram_bytes"), 0.2);
    EXPECT_GT(chosen(reported(run + "--fidelity auto --error 0.15")), 0U);
}

// Where no samples can be taken, pilots in both modes decide.
TEST_F(Fidelity, TakesTheFastModeByAPilot) {
    const std::string machine = frame("box", "tiny", "128x96") +
                                "-g coherence.plain=directory -g l2.inclusion=inclusive --workers 2 ";
    const nlohmann::json truth = reported(machine + whole);
    const nlohmann::json r = reported(machine + "--fidelity auto --error 0.6");
    const nlohmann::json& way = r.at("fidelity").at("ways")[chosen(r)];
    EXPECT_EQ(way.at("way").get<std::string>().substr(0, 9), "fast mode") << r.at("fidelity");
    EXPECT_NE(way.at("source").get<std::string>().find("pilot"), std::string::npos);
    EXPECT_EQ(r.at("mode"), "fast");
    EXPECT_LE(std::abs(r.at("cycles").get<double>() / truth.at("cycles").get<double>() - 1),
              1.5 * r.at("fidelity").at("error").at("cycles").get<double>());
    const nlohmann::json exact = reported(machine + "--fidelity auto --error 0.0001");
    EXPECT_EQ(exact.at("mode"), "reference");
    EXPECT_EQ(exact.at("cycles"), truth.at("cycles"));
}

TEST_F(Fidelity, RefusesMistakesWithOneLine) {
    const std::pair<const char*, const char*> wrong[] = {
        {"--fidelity auto", "give --error E"},
        {"--error 0.1", "of no use without --fidelity auto"},
        {"--fidelity best --error 0.1", "is no fidelity; give auto"},
        {"--fidelity auto --error -1", "from 0 to 1"},
        {"--fidelity auto --error x", "--error"},
        {"--fidelity auto --error nan", "--error"},
        {"--fidelity auto --error 0.1 --estimate sample:0.1", "leave out --estimate"},
        {"--fidelity auto --error 0.1 --frames 2", "leave out --frames"},
        {"--fidelity auto --error 0.1 -o a.exr", "leave out -o"},
        {"--fidelity auto --error 0.1 --trace a.rzt", "leave out --trace"},
        {"--fidelity auto --error 0.1 --host-threads 2", "leave out --host-threads"},
    };
    for (const auto& [options, says] : wrong) {
        SCOPED_TRACE(options);
        const Outcome result = simulator(frame("box", "tiny") + options + " --json a.json");
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "a.json"));
    }
}

} // namespace
} // namespace razor
