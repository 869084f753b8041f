// Embree's scenes: one of all that is flattened and of instances, and one of each mesh that is instanced.
#pragma once

#include "tests/benchmarks/embree/records.h"
#include "tests/benchmarks/embree/renderer.h"

#include <atomic>
#include <span>
#include <vector>

namespace razor::baseline {

/// Quads in arrays that outlive the scenes.
struct Geometry {
    const float* positions;
    std::size_t position_bytes, vertices; // where its own begin, and how many there are
    const std::int32_t* quads;
    std::size_t quad_bytes, quad_count;
    bool instanced;
    std::span<const Piece> pieces; // it is drawn by; one if not instanced
};

class EmbreeScenes {
public:
    EmbreeScenes(int threads, Quality quality);
    ~EmbreeScenes();
    EmbreeScenes(const EmbreeScenes&) = delete;
    EmbreeScenes& operator=(const EmbreeScenes&) = delete;

    /// In place of those before. Geometry of the top scene is numbered as the pieces are, in order.
    void build(const std::vector<Geometry>& geometries);
    RTCScene top() const { return top_; }
    /// What Embree holds.
    std::int64_t bytes() const { return bytes_; }

private:
    RTCScene make_scene() const;
    RTCGeometry make_quads(const Geometry& geometry) const;
    void release();

    int threads_;
    RTCBuildQuality quality_;
    RTCDevice device_ = nullptr;
    RTCScene top_ = nullptr;
    std::vector<RTCScene> bases_;
    std::atomic<std::int64_t> bytes_ = 0;
};

} // namespace razor::baseline
