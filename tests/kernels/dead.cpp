// What kernels say to be dead: nobody reads it before it is written anew, and at the frame's end it is all
// that was built.
#include "tests/kernels/cages.h"
#include "tests/kernels/recording_port.h"
#include "tests/kernels/targets.h"

#include "razor/frame/frame.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <unordered_map>

namespace razor::test {
namespace {

/// Words of frame memory that were written, and whether they are dead.
class Dead final : public Listener {
public:
    explicit Dead(const isa::address_space& memory) : memory_(memory) {}

    void read(const void* p, std::uint32_t bytes) override {
        each_word(p, bytes, [this](std::uint64_t word) {
            const auto found = dead_.find(word);
            if (found != dead_.end() && found->second)
                ++read_[structure_of(word)];
        });
    }
    void write(const void* p, std::uint32_t bytes) override {
        each_word(p, bytes, [this](std::uint64_t word) { dead_[word] = false; });
    }
    void discard(const void* p, std::uint32_t bytes) override {
        EXPECT_EQ(memory_.offset(p) % line_bytes, 0U);
        EXPECT_EQ(bytes % line_bytes, 0U);
        each_word(p, bytes, [this](std::uint64_t word) {
            const auto found = dead_.find(word);
            discarded_ += found != dead_.end() ? 1 : 0;
            if (found != dead_.end())
                found->second = true;
        });
    }

    std::uint64_t discarded() const { return discarded_; }
    /// Dead words that were read, by structure.
    const std::map<std::string, std::uint64_t>& read() const { return read_; }
    /// Words that were written and are not dead.
    std::map<std::string, std::uint64_t> alive() const {
        std::map<std::string, std::uint64_t> out;
        for (const auto& [word, dead] : dead_)
            if (!dead)
                ++out[structure_of(word)];
        return out;
    }

private:
    template <class Visit> void each_word(const void* p, std::uint32_t bytes, Visit visit) {
        const std::uint64_t first = memory_.offset(p) / 4;
        for (std::uint64_t word = first; word < (memory_.offset(p) + bytes + 3) / 4; ++word)
            visit(word);
    }
    /// Of the grids, the arenas: tables of a tree (opened patches, lengths of curves) are smaller regions.
    std::string structure_of(std::uint64_t word) const {
        const isa::region& r = *memory_.find(word * 4);
        return r.structure == "grids" && r.end - r.begin < (1U << 24) ? "tables" : r.structure;
    }

    const isa::address_space& memory_;
    std::unordered_map<std::uint64_t, bool> dead_; // by word
    std::uint64_t discarded_ = 0;                  // words that had been written
    std::map<std::string, std::uint64_t> read_;
};

Scene small(const char* name) {
    Scene scene = named_scene(name)->scene;
    scene.settings.width = scene.settings.height = 40;
    scene.settings.samples = 1;
    scene.settings.light_samples = scene.settings.sky_samples = 1;
    return scene;
}

TEST(Dead, IsNotReadAndAtTheEndAllThatWasBuilt) {
    for (const char* name : {"default", "urchin_stretched", "torus_bilinear"}) {
        SCOPED_TRACE(name);
        const Scene scene = small(name);
        Frame keeps(scene, {}), drops(scene, {.discards = true});
        for (int part = 0; part < 2; ++part) {
            // In two parts, of which the second finds what the first has built.
            SCOPED_TRACE(part);
            for (const bool discards : {false, true}) {
                Frame& frame = discards ? drops : keeps;
                frame.reset();
                Dead dead(frame.memory());
                listen(&dead);
                for (int first = 0; first <= part; ++first) {
                    frame.take_tiles(first * 4, part == first ? screen_tiles(scene.settings) : 4);
                    frame.render(simulated::kernels, 0);
                }
                listen(nullptr);
                EXPECT_TRUE(dead.read().empty()) << dead.read().begin()->first;
                std::map<std::string, std::uint64_t> alive = dead.alive();
                if (!discards) {
                    EXPECT_EQ(dead.discarded(), 0U);
                    EXPECT_GT(alive["item lists"], 1000U);
                    continue;
                }
                EXPECT_GT(dead.discarded(), 10000U);
                for (const char* structure : {"grids", "item lists", "kd nodes", "blended blocks", "packets"})
                    EXPECT_LE(alive[structure], structure == std::string("kd nodes") ? 16U : 0U) << structure;
                EXPECT_GT(alive["frame buffer"], 0U);
            }
            const Film expected = keeps.film(), got = drops.film();
            for (const Plane& plane : expected.planes)
                EXPECT_EQ(got.find(plane.name)->values, plane.values) << plane.name;
        }
    }
}

} // namespace
} // namespace razor::test
