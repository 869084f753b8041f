#include "tests/benchmarks/embree/embree_scenes.h"

#include "razor/scene/error.h"
#include "tests/benchmarks/embree/parallel.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

namespace razor::baseline {
namespace {

RTCBuildQuality embree_quality(Quality quality) {
    switch (quality) {
    case Quality::low:
        return RTC_BUILD_QUALITY_LOW;
    case Quality::medium:
        return RTC_BUILD_QUALITY_MEDIUM;
    case Quality::high:
        return RTC_BUILD_QUALITY_HIGH;
    }
    return RTC_BUILD_QUALITY_MEDIUM;
}

/// From here on Embree's builders share one scene's work among threads.
constexpr std::size_t large_scene = 16384; // quads

} // namespace

EmbreeScenes::EmbreeScenes(int threads, Quality quality)
    : threads_(threads), quality_(embree_quality(quality)),
      device_(rtcNewDevice(fmt::format("threads={}", threads).c_str())) {
    if (device_ == nullptr)
        throw UserError("Embree gives no device");
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* self, ssize_t change, bool) {
            static_cast<EmbreeScenes*>(self)->bytes_ += change;
            return true;
        },
        this);
}

EmbreeScenes::~EmbreeScenes() {
    release();
    rtcReleaseDevice(device_);
}

void EmbreeScenes::release() {
    if (top_ != nullptr)
        rtcReleaseScene(top_);
    top_ = nullptr;
    for (RTCScene base : bases_)
        rtcReleaseScene(base);
    bases_.clear();
}

RTCScene EmbreeScenes::make_scene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST); // no ray slips through an edge, as of Razor's
    rtcSetSceneBuildQuality(scene, quality_);
    return scene;
}

RTCGeometry EmbreeScenes::make_quads(const Geometry& g) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
    rtcSetGeometryBuildQuality(geometry, quality_);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, g.positions,
                               g.position_bytes, 12, g.vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, g.quads, g.quad_bytes,
                               16, g.quad_count);
    rtcCommitGeometry(geometry);
    return geometry;
}

void EmbreeScenes::build(const std::vector<Geometry>& geometries) {
    release();
    std::vector<std::size_t> order; // of the instanced, the largest first
    std::vector<RTCScene> base_of(geometries.size(), nullptr);
    for (std::size_t g = 0; g < geometries.size(); ++g)
        if (geometries[g].instanced) {
            order.push_back(g);
            bases_.push_back(base_of[g] = make_scene());
            RTCGeometry quads = make_quads(geometries[g]);
            rtcAttachGeometryByID(base_of[g], quads, 0);
            rtcReleaseGeometry(quads);
        }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return geometries[a].quad_count > geometries[b].quad_count;
    });
    const auto small = std::find_if(order.begin(), order.end(),
                                    [&](std::size_t g) { return geometries[g].quad_count < large_scene; });
    std::for_each(order.begin(), small, [&](std::size_t g) { rtcCommitScene(base_of[g]); });
    share_out(threads_, static_cast<int>(order.end() - small),
              [&](int n, int) { rtcCommitScene(base_of[*(small + n)]); });

    top_ = make_scene();
    unsigned number = 0;
    for (std::size_t g = 0; g < geometries.size(); ++g) {
        if (!geometries[g].instanced) {
            RTCGeometry quads = make_quads(geometries[g]);
            rtcAttachGeometryByID(top_, quads, number++);
            rtcReleaseGeometry(quads);
            continue;
        }
        for (const Piece& p : geometries[g].pieces) {
            RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(instance, base_of[g]);
            float columns[12];
            for (int row = 0; row < 3; ++row) {
                for (int column = 0; column < 3; ++column)
                    columns[3 * column + row] = p.linear[3 * row + column];
                columns[9 + row] = p.shift[row];
            }
            rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
            rtcCommitGeometry(instance);
            rtcAttachGeometryByID(top_, instance, number++);
            rtcReleaseGeometry(instance);
        }
    }
    rtcCommitScene(top_);
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
        throw UserError(fmt::format("Embree: error {}", static_cast<int>(error)));
}

} // namespace razor::baseline
