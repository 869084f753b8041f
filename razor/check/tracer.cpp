#include "razor/check/tracer.h"

#include <algorithm>
#include <stdexcept>

namespace razor::check {

Tracer::Tracer(Frame& frame, int capacity, double reaches)
    : frame_(frame), capacity_(static_cast<std::size_t>(capacity)) {
    for (float*& p : in_)
        p = frame.extra<float>("packets", capacity_);
    for (float*& p : out_)
        p = frame.extra<float>("packets", capacity_);
    for (std::int32_t*& p : names_)
        p = frame.extra<std::int32_t>("packets", capacity_);
    frame.set_reach(reaches * static_cast<double>(frame.header().reach));
}

TraceArguments Tracer::fill(const std::vector<Ray>& rays) {
    if (rays.size() > capacity_)
        throw std::logic_error("more rays than there is room for");
    TraceArguments a;
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            in_[k][i] = rays[i].origin[k];
            in_[3 + k][i] = rays[i].direction[k];
        }
        a.origin[k] = in_[k];
        a.direction[k] = in_[3 + k];
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        in_[6][i] = rays[i].t_min;
        in_[7][i] = rays[i].t_max;
        in_[8][i] = rays[i].base;
        in_[9][i] = rays[i].growth;
        for (std::size_t k = 0; k < 3; ++k)
            in_[10 + k][i] = rays[i].slope[k];
    }
    bool any_field = std::any_of(rays.begin(), rays.end(), [](const Ray& r) { return r.base != 0; });
    a.base = any_field ? in_[8] : nullptr;
    a.growth = any_field ? in_[9] : nullptr;
    for (std::size_t k = 0; k < 3; ++k)
        a.slope[k] = in_[10 + k];
    a.t_min = in_[6];
    a.t_max = in_[7];
    a.count = static_cast<int>(rays.size());
    a.t = out_[0];
    a.u = out_[1];
    a.v = out_[2];
    a.patch = names_[0];
    a.triangle = names_[1];
    std::fill_n(a.patch, rays.size(), -7);
    return a;
}

std::vector<Hit> Tracer::closest(const KernelTable& kernels, const std::vector<Ray>& rays) {
    frame_.trace(kernels, fill(rays));
    std::vector<Hit> hits;
    for (std::size_t i = 0; i < rays.size(); ++i)
        hits.push_back({names_[0][i], names_[1][i], out_[0][i], out_[1][i], out_[2][i]});
    return hits;
}

std::vector<bool> Tracer::any(const KernelTable& kernels, const std::vector<Ray>& rays) {
    TraceArguments a = fill(rays);
    a.any_hit = true;
    frame_.trace(kernels, a);
    std::vector<bool> hit;
    for (std::size_t i = 0; i < rays.size(); ++i)
        hit.push_back(names_[0][i] >= 0);
    return hit;
}

std::vector<Point> instance_origins(Frame& frame) {
    const InstanceRecord* instance = frame.header().instances.get();
    std::vector<Point> origins;
    for (std::int64_t n = frame.statistics().instances; n > 0; --n, ++instance)
        origins.push_back({instance->origin[0], instance->origin[1], instance->origin[2]});
    return origins;
}

} // namespace razor::check
