// Camera and shadow rays a second on one thread, beside Embree on the same triangles and the same rays.
//   trace_rays MODEL.obj [--triangles 1000000] [--size 1024] [--isa auto] [--repeat 5]
// Both sides are measured in turn, with everything built (our lazy builds by a first pass over the rays).
#include "razor/frame/frame.h"
#include "razor/native/targets.h"
#include "razor/scene/error.h"
#include "razor/scene/framing.h"

#include <CLI/CLI.hpp>
#include <embree3/rtcore.h>
#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace {

using namespace razor;
using Clock = std::chrono::steady_clock;

double seconds(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Rays as the kernels take them: arrays in frame memory.
struct RayArrays {
    int count = 0;
    float* origin[3] = {};
    float* direction[3] = {};
    float *t_min = nullptr, *t_max = nullptr;
    float *t = nullptr, *u = nullptr, *v = nullptr;
    std::int32_t *patch = nullptr, *triangle = nullptr;

    RayArrays(Frame& frame, int n) : count(n) {
        auto room = static_cast<std::size_t>(n) + 64;
        for (int k = 0; k < 3; ++k) {
            origin[k] = frame.extra<float>("rays", room);
            direction[k] = frame.extra<float>("rays", room);
        }
        for (float** p : {&t_min, &t_max, &t, &u, &v})
            *p = frame.extra<float>("rays", room);
        patch = frame.extra<std::int32_t>("rays", room);
        triangle = frame.extra<std::int32_t>("rays", room);
    }
    TraceArguments arguments(bool any_hit) const {
        TraceArguments a;
        for (int k = 0; k < 3; ++k) {
            a.origin[k] = origin[k];
            a.direction[k] = direction[k];
        }
        a.t_min = t_min;
        a.t_max = t_max;
        a.count = count;
        a.any_hit = any_hit;
        a.t = t;
        a.u = u;
        a.v = v;
        a.patch = patch;
        a.triangle = triangle;
        return a;
    }
    void put(int i, const glm::vec3& o, const glm::vec3& d, float far) const {
        for (int k = 0; k < 3; ++k) {
            origin[k][i] = o[k];
            direction[k][i] = d[k];
        }
        t_min[i] = 0;
        t_max[i] = far;
    }
};

/// Camera rays in packets of 8 x 4 pixels, through pixel centres.
void camera_rays(const FrameHeader& h, RayArrays& rays, int size) {
    int i = 0;
    for (int y = 0; y < size; y += 4)
        for (int x = 0; x < size; x += 8)
            for (int l = 0; l < 32; ++l, ++i) {
                glm::vec3 d;
                for (int k = 0; k < 3; ++k)
                    d[k] = h.film_corner[k] + h.film_x[k] * (static_cast<float>(x + l % 8) + 0.5F) +
                           h.film_y[k] * (static_cast<float>(y + l / 8) + 0.5F);
                rays.put(i, {h.camera[0], h.camera[1], h.camera[2]}, glm::normalize(d), 3.0e38F);
            }
}

/// Four points of the first light for each hit; 8 hits x 4 samples are a packet.
int shadow_rays(const FrameHeader& h, const RayArrays& camera, const RayArrays& rays) {
    const LightRecord& light = *h.lights.get();
    int n = 0;
    for (int i = 0; i < camera.count; ++i) {
        if (camera.patch[i] < 0)
            continue;
        glm::vec3 d(camera.direction[0][i], camera.direction[1][i], camera.direction[2][i]);
        glm::vec3 o(camera.origin[0][i], camera.origin[1][i], camera.origin[2][i]);
        glm::vec3 p = o + d * (camera.t[i] * 0.9999F);
        for (int s = 0; s < 4; ++s) {
            float u = 0.25F + 0.5F * static_cast<float>(s % 2), v = 0.25F + 0.5F * static_cast<float>(s / 2);
            glm::vec3 q;
            for (int k = 0; k < 3; ++k)
                q[k] = light.corner[k] + u * light.edge_u[k] + v * light.edge_v[k];
            glm::vec3 way = q - p;
            float length = glm::length(way);
            rays.put(n++, p, way / length, length * 0.9999F);
        }
    }
    return n;
}

/// Appends the triangles of the finest blocks at or below the one at `line`, in scene coordinates.
void add_finest(const FrameHeader& h, int line, std::vector<glm::vec3>& corners) {
    const Line* at = h.grids.get() + line;
    const auto* block = reinterpret_cast<const BlockHeader*>(at);
    if (block->level > 0 && block->children.word == ready) {
        const int children = razor::children_in(block->child_shape);
        for (int k = 0; k < children; ++k)
            add_finest(h, block->child_line + k * razor::lines_between(block->child_shape), corners);
        return;
    }
    const auto* x = reinterpret_cast<const float*>(at) + block_header_words;
    const float* origin = h.instances.get()[block->instance].origin;
    int width = block->quads_u + 1;
    auto vertex = [&](int i, int j) {
        const float* v = x + j * width + i;
        return glm::vec3(v[0] + origin[0], v[block->stride] + origin[1], v[2 * block->stride] + origin[2]);
    };
    for (int j = 0; j < block->quads_v; ++j)
        for (int i = 0; i < block->quads_u; ++i) {
            for (glm::vec3 v : {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)})
                corners.push_back(v);
            if (block->triangles == 2)
                for (glm::vec3 v : {vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)})
                    corners.push_back(v);
        }
}

/// The tessellation that the frame holds, each patch at its finest level.
std::vector<glm::vec3> tessellation(const FrameHeader& h) {
    std::vector<glm::vec3> corners;
    const OpenPatch* open = h.trees.get()[0].patches.get();
    for (int p = 0; p < h.patch_count; ++p)
        if (open[p].state.word == ready)
            add_finest(h, open[p].root, corners);
    return corners;
}

class Embree {
public:
    explicit Embree(const std::vector<glm::vec3>& corners) : device_(rtcNewDevice("threads=1")) {
        auto begin = Clock::now();
        scene_ = rtcNewScene(device_);
        RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* v = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), corners.size()));
        std::copy(corners.begin(), corners.end(), v);
        auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
            g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), corners.size() / 3));
        for (std::size_t i = 0; i < corners.size(); ++i)
            index[i] = static_cast<unsigned>(i);
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene_, g);
        rtcReleaseGeometry(g);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST); // watertight, as ours
        rtcCommitScene(scene_);
        build_seconds = seconds(begin);
    }
    ~Embree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    /// Traces all rays; counts those that hit.
    int trace(const RayArrays& r, bool any_hit) const {
        int hits = 0;
        alignas(64) int valid[16];
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = any_hit ? RTC_INTERSECT_CONTEXT_FLAG_NONE : RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        for (int i = 0; i < r.count; i += 16) {
            alignas(64) RTCRayHit16 packet;
            for (int l = 0; l < 16; ++l) {
                valid[l] = i + l < r.count ? -1 : 0;
                int k = std::min(i + l, r.count - 1);
                packet.ray.org_x[l] = r.origin[0][k];
                packet.ray.org_y[l] = r.origin[1][k];
                packet.ray.org_z[l] = r.origin[2][k];
                packet.ray.dir_x[l] = r.direction[0][k];
                packet.ray.dir_y[l] = r.direction[1][k];
                packet.ray.dir_z[l] = r.direction[2][k];
                packet.ray.tnear[l] = r.t_min[k];
                packet.ray.tfar[l] = r.t_max[k];
                packet.ray.mask[l] = ~0U;
                packet.ray.time[l] = 0;
                packet.hit.geomID[l] = RTC_INVALID_GEOMETRY_ID;
            }
            if (any_hit)
                rtcOccluded16(valid, scene_, &context, &packet.ray);
            else
                rtcIntersect16(valid, scene_, &context, &packet);
            for (int l = 0; l < 16 && i + l < r.count; ++l)
                hits += any_hit ? packet.ray.tfar[l] < 0 : packet.hit.geomID[l] != RTC_INVALID_GEOMETRY_ID;
        }
        return hits;
    }
    double build_seconds = 0;

private:
    RTCDevice device_;
    RTCScene scene_ = nullptr;
};

int hits_of(const RayArrays& r) {
    return static_cast<int>(std::count_if(r.patch, r.patch + r.count, [](int p) { return p >= 0; }));
}

struct Spread {
    double low, median, high;
};
Spread spread(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return {v.front(), v[v.size() / 2], v.back()};
}

template <class Ours, class Theirs>
void compare(const char* what, int rays, int repeat, Ours ours, Theirs theirs) {
    std::vector<double> a, b, ratio;
    for (int i = 0; i < repeat; ++i) {
        auto begin = Clock::now();
        ours();
        a.push_back(rays / seconds(begin) * 1e-6);
        begin = Clock::now();
        theirs();
        b.push_back(rays / seconds(begin) * 1e-6);
        ratio.push_back(a.back() / b.back());
    }
    Spread x = spread(a), y = spread(b), z = spread(ratio);
    fmt::print("{:8} {:9} rays  razor {:6.2f} [{:.2f} .. {:.2f}]  Embree {:6.2f} [{:.2f} .. {:.2f}] Mrays/s  "
               "ratio {:.2f} "
               "[{:.2f} .. {:.2f}]\n",
               what, rays, x.median, x.low, x.high, y.median, y.low, y.high, z.median, z.low, z.high);
}

void run(const std::string& model, double triangles, int size, const std::string& isa, int repeat) {
    const KernelTable& kernels = native_target(isa);
    FramingOptions framing;
    framing.floor = false;
    framing.settings.width = framing.settings.height = size;
    Scene scene = build_scene(frame_model(model, framing));
    // The level whose tessellation comes nearest to the wanted number of triangles.
    std::unique_ptr<Frame> frame;
    double best = 1e30;
    double chosen = 0;
    for (int level = 0; level > -14; --level) {
        scene.meshes[0].edge_length = std::exp2(level);
        Frame trial(scene, {});
        trial.build_all(kernels);
        double made = static_cast<double>(trial.statistics().counters.triangles_made);
        if (std::abs(std::log(made / triangles)) < best) {
            best = std::abs(std::log(made / triangles));
            chosen = scene.meshes[0].edge_length;
        }
        if (made > triangles)
            break;
    }
    scene.meshes[0].edge_length = chosen;
    Frame whole(scene, {});
    whole.build_all(kernels);
    std::vector<glm::vec3> corners = tessellation(whole.header());
    Embree embree(corners);

    Frame lazy(scene, {});
    RayArrays camera(lazy, size * size);
    RayArrays shadow(lazy, size * size * 4);
    camera_rays(lazy.header(), camera, size);
    auto begin = Clock::now();
    lazy.trace(kernels, camera.arguments(false));
    double first = seconds(begin);
    shadow.count = shadow_rays(lazy.header(), camera, shadow);
    lazy.trace(kernels, shadow.arguments(true));
    FrameStatistics s = lazy.statistics();
    Counters before = s.counters;
    for (bool any_hit : {false, true}) {
        const RayArrays& rays = any_hit ? shadow : camera;
        lazy.trace(kernels, rays.arguments(any_hit));
        Counters after = lazy.statistics().counters;
        double packets = std::ceil(rays.count / static_cast<double>(kernels.width));
        fmt::print("{} packet: {:.1f} groups, {:.1f} nodes, {:.1f} boxes, {:.1f} blocks, {:.1f} cells, "
                   "{:.1f} quads\n",
                   any_hit ? "shadow" : "camera", static_cast<double>(after.groups - before.groups) / packets,
                   static_cast<double>(after.node_visits - before.node_visits) / packets,
                   static_cast<double>(after.box_tests - before.box_tests) / packets,
                   static_cast<double>(after.block_tests - before.block_tests) / packets,
                   static_cast<double>(after.cell_tests - before.cell_tests) / packets,
                   static_cast<double>(after.quad_tests - before.quad_tests) / packets);
        before = after;
    }
    int our_hits = hits_of(camera), our_shadows = hits_of(shadow);
    fmt::print("{}: {} triangles, target edge {}, {} kernels of width {}\n", model, corners.size() / 3,
               chosen, kernels.name, kernels.width);
    fmt::print("first pass over the camera rays, builds included: {:.0f} ms ({} of {} patches opened); "
               "Embree builds in "
               "{:.0f} ms\n",
               first * 1e3, s.counters.patches_opened, s.patches, embree.build_seconds * 1e3);
    fmt::print("hits: camera {} and {}, shadow {} and {}\n", our_hits, embree.trace(camera, false),
               our_shadows, embree.trace(shadow, true));
    // The refit of trace() is part of a frame, not of tracing: reset() is not called, so it finds nothing to
    // do.
    compare(
        "camera", camera.count, repeat, [&] { lazy.trace(kernels, camera.arguments(false)); },
        [&] { embree.trace(camera, false); });
    compare(
        "shadow", shadow.count, repeat, [&] { lazy.trace(kernels, shadow.arguments(true)); },
        [&] { embree.trace(shadow, true); });
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Camera and shadow rays a second beside Embree");
    std::string model, isa = "auto";
    double triangles = 1e6;
    int size = 1024, repeat = 5;
    app.add_option("model", model)->required();
    app.add_option("--triangles", triangles);
    app.add_option("--size", size);
    app.add_option("--isa", isa);
    app.add_option("--repeat", repeat);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    try {
        run(model, triangles, size, isa, repeat);
    } catch (const razor::UserError& e) {
        fmt::print(stderr, "trace_rays: {}\n", e.what());
        return 2;
    }
    return 0;
}
