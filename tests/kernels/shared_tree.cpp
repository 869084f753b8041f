// Workers that share trees and grids, meant for ThreadSanitizer: every publication is an atomic, nothing else
// races.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/native/render.h"

#include <gtest/gtest.h>

#include <cstring>

namespace razor::test {
namespace {

TEST(SharedTree, ManyWorkersOneTree) {
    for (const char* name : {"urchin_stretched", "torus_bilinear"}) {
        Scene scene = named_scene(name)->scene;
        scene.settings.width = scene.settings.height = 96; // tiles for everybody
        const KernelTable& kernels = *native_targets().back();
        std::vector<float> first;
        for (int share : {0, 3}) {
            Frame frame(scene, {.workers = 6, .share = share});
            for (int again = 0; again < 3; ++again) {
                frame.reset(); // pages stay: the first time they are made under everybody's eyes
                run_workers(frame, kernels);
                const FrameHeader& h = frame.header();
                const float* film = h.film.get();
                std::vector<float> picture(film, film + static_cast<std::ptrdiff_t>(h.width) * h.height *
                                                            film_planes);
                if (first.empty())
                    first = picture;
                ASSERT_EQ(std::memcmp(first.data(), picture.data(), first.size() * sizeof(float)), 0);
            }
        }
    }
}

} // namespace
} // namespace razor::test
