// Nothing is free: whatever the native kernels read of what the host gave them, and whatever they write, the
// simulated kernels read and write too, through the timing port.
//
// A simulated render tells which bytes it read before it wrote them. In a native frame of the same scene
// every other byte of frame memory is overwritten with noise; the picture must not change by a bit. And every
// byte that changes must be one that the simulated render stored. (Both are a frame's second render: topology
// pages are the host's work.)
#include "tests/kernels/cages.h"
#include "tests/kernels/recording_port.h"
#include "tests/kernels/targets.h"
#include "tests/materials/room.h"

#include "razor/frame/frame.h"
#include "traces/footprint.h"

#include <gtest/gtest.h>

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>
#include <string>

namespace razor::test {
namespace {

constexpr FrameOptions small_arenas{
    .workers = 1, .grid_bytes = 1 << 24, .node_bytes = 1 << 20, .list_bytes = 1 << 23};

class FootprintListener final : public Listener {
public:
    FootprintListener(isa::address_space& memory, traces::Footprint& footprint)
        : memory_(memory), footprint_(footprint) {}
    void read(const void* p, std::uint32_t bytes) override { footprint_.read(memory_.offset(p), bytes); }
    void write(const void* p, std::uint32_t bytes) override { footprint_.write(memory_.offset(p), bytes); }

private:
    isa::address_space& memory_;
    traces::Footprint& footprint_;
};

traces::Footprint simulated_footprint(const Scene& scene) {
    Frame frame(scene, small_arenas);
    frame.render(simulated::kernels, 0);
    frame.reset();
    traces::Footprint footprint;
    FootprintListener listener(frame.memory(), footprint);
    listen(&listener);
    frame.render(simulated::kernels, 0);
    listen(nullptr);
    return footprint;
}

/// Visits host pages of a frame's regions that hold anything but untouched zeros.
template <class Visit> void each_resident_page(isa::address_space& memory, Visit visit) {
    auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    for (const isa::region& r : memory.regions()) {
        constexpr std::uint64_t chunk = std::uint64_t{1} << 26;
        for (std::uint64_t begin = r.begin; begin < r.end; begin += chunk) {
            std::uint64_t bytes = std::min(chunk, r.end - begin);
            std::vector<unsigned char> resident((bytes + page - 1) / page);
            ASSERT_EQ(mincore(memory.base() + begin, bytes, resident.data()), 0);
            for (std::size_t i = 0; i < resident.size(); ++i)
                if ((resident[i] & 1) != 0)
                    visit(r, begin + i * page, std::min(begin + (i + 1) * page, r.end));
        }
    }
}

std::vector<float> film_of(Frame& frame, int width, int height) {
    const float* film = frame.header().film.get();
    return {film, film + static_cast<std::ptrdiff_t>(width) * height * film_planes};
}

class NothingIsFree : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        scene_ = GetParam() == "flat"    ? scene_of(bilinear(cube_cage()), 10)
                 : GetParam() == "paths" ? full_room()
                                         : named_scene(GetParam())->scene;
    }
    Scene scene_;
};

TEST_P(NothingIsFree, NativeReadsAndWritesNothingElse) {
    traces::Footprint simulated = simulated_footprint(scene_);
    EXPECT_GT(simulated.input_bytes(), 500U);
    EXPECT_GT(simulated.bytes_written(), 1000U);
    for (const KernelTable* target : native_targets()) {
        if (std::strcmp(target->name, "sse4") == 0)
            continue; // other bits, other paths
        Frame frame(scene_, small_arenas);
        frame.render(*target, 0);
        std::vector<float> expected = film_of(frame, scene_.settings.width, scene_.settings.height);
        frame.reset();

        std::mt19937 random(5);
        std::uint64_t noisy = 0;
        isa::address_space& memory = frame.memory();
        each_resident_page(memory, [&](const isa::region&, std::uint64_t begin, std::uint64_t end) {
            for (std::uint64_t i = begin; i < end; ++i)
                if (!simulated.is_input(i)) {
                    memory.base()[i] = static_cast<std::byte>(random());
                    ++noisy;
                }
        });
        EXPECT_GT(noisy, 10'000U);
        std::vector<std::pair<std::uint64_t, std::vector<std::byte>>> before;
        each_resident_page(memory, [&](const isa::region&, std::uint64_t begin, std::uint64_t end) {
            before.emplace_back(begin, std::vector<std::byte>(memory.base() + begin, memory.base() + end));
        });

        frame.render(*target, 0);

        // Pages that only became resident now held zeros before.
        std::map<std::uint64_t, const std::vector<std::byte>*> old;
        for (const auto& [begin, bytes] : before)
            old[begin] = &bytes;
        std::map<std::string, std::uint64_t> unstored;
        each_resident_page(memory, [&](const isa::region& r, std::uint64_t begin, std::uint64_t end) {
            auto found = old.find(begin);
            for (std::uint64_t i = begin; i < end; ++i) {
                std::byte was = found == old.end() ? std::byte{0} : (*found->second)[i - begin];
                if (memory.base()[i] != was && !simulated.is_written(i))
                    ++unstored[r.structure];
            }
        });
        for (const auto& [structure, bytes] : unstored)
            ADD_FAILURE() << target->name << " changed " << bytes << " bytes of " << structure
                          << " that the simulated kernels did not store";

        std::vector<float> got = film_of(frame, scene_.settings.width, scene_.settings.height);
        EXPECT_EQ(std::memcmp(got.data(), expected.data(), got.size() * sizeof(float)), 0)
            << target->name << " read something that the simulated kernels did not";
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, NothingIsFree,
                         testing::Values("default", "urchin_stretched", "torus_bilinear", "flat", "paths"),
                         [](const auto& name) { return name.param; });

} // namespace
} // namespace razor::test
