// native_frame: one worker renders a frame with one native target, its arenas so small that valgrind can lay
// them out: what calibrate.py counts the kernels' instructions and data references of. The picture is that of
// `razor render` with the same target and one thread, bit for bit.
#include "razor/frame/frame.h"
#include "razor/image/output.h"
#include "razor/native/targets.h"
#include "razor/program/arguments.h"
#include "razor/program/scene_options.h"

#include <fmt/core.h>

namespace {

constexpr razor::Range arena_range{1, 8192};

class NativeFrame {
public:
    void add_to(CLI::App& app) {
        scene_.add_to(app, "scene");
        app.add_option("--isa", isa_, "the kernels' target: plain, sse4, avx2 or avx512")
            ->type_name("NAME")
            ->required();
        app.add_option(
               "--arena", arena_,
               "MiB of addresses for each of grids, kd nodes, lists and topology pages; without it, 512")
            ->type_name("MIB");
        app.add_option("-o,--output", output_, "the picture: .exr or .png")->type_name("FILE");
    }

    int run() const {
        const razor::KernelTable& kernels = razor::native_target(isa_);
        const auto arena = static_cast<std::uint64_t>(razor::parse_whole("--arena", arena_, arena_range))
                           << 20U;
        const razor::SceneDescription description = scene_.describe();
        if (!output_.empty())
            razor::check_output(output_);
        const razor::Scene scene = razor::build_scene(description);
        razor::Frame frame(scene, {.workers = 1,
                                   .grid_bytes = arena,
                                   .node_bytes = arena,
                                   .list_bytes = arena,
                                   .page_bytes = arena});
        frame.render(kernels, 0);
        if (!output_.empty())
            razor::write_image(output_, frame.film(), {});
        const razor::FrameStatistics s = frame.statistics();
        fmt::print("{} lanes of {}, compiler {}: {} rays, {} triangles\n", kernels.width, kernels.name,
                   __VERSION__, s.counters.rays, s.counters.triangles_made);
        return 0;
    }

private:
    razor::SceneOptions scene_;
    std::string isa_, arena_ = "512", output_;
};

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Renders a frame with one worker and bounded arenas, for valgrind.", "native_frame");
    NativeFrame frame;
    frame.add_to(app);
    return razor::run_program(app, argc, argv, [&] { return frame.run(); });
}
