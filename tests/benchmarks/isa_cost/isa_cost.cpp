// isa_cost TARGET vocabulary|intrinsics|wide_intrinsics [PACKETS]: runs one version of the kernel and prints
// nanoseconds a packet of 32 rays and a sum over the results, which all versions share. See compare.py.
#include "packet.h"
#include "targets.h"

#include "isa/cpu.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string_view>

#define DECLARE(target)                                                                                                \
    namespace isa_cost::target {                                                                                       \
    bool vocabulary(const triangle&, rays&, int);                                                                      \
    bool intrinsics(const triangle&, rays&, int);                                                                      \
    bool wide_intrinsics(const triangle&, rays&, int);                                                                 \
    }
ISA_COST_TARGETS(DECLARE)

int main(int argc, char** argv) {
    std::string_view target = argc > 2 ? argv[1] : "", version = argc > 2 ? argv[2] : "";
    long packets = argc > 3 ? std::atol(argv[3]) : 1000;
    isa_cost::kernel kernel = nullptr;
#define CHOOSE(name)                                                                                                   \
    if (target == #name)                                                                                               \
        kernel = version == "vocabulary"        ? &isa_cost::name::vocabulary                                          \
                 : version == "intrinsics"      ? &isa_cost::name::intrinsics                                          \
                 : version == "wide_intrinsics" ? &isa_cost::name::wide_intrinsics                                     \
                                                : nullptr;
    ISA_COST_TARGETS(CHOOSE)
    if (kernel == nullptr || !isa::cpu_runs(target)) {
        std::fprintf(stderr, "usage: isa_cost TARGET vocabulary|intrinsics|wide_intrinsics [PACKETS], on a processor "
                             "that runs TARGET\n");
        return 2;
    }
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-1.0F, 1.0F);
    static isa_cost::rays r;
    for (int lane = 0; lane < 32; ++lane)
        for (int k = 0; k < 3; ++k) {
            r.origin[k][lane] = number(random) - (k == 2 ? 3.0F : 0.0F);
            r.direction[k][lane] = k == 2 ? 1.0F : 0.3F * number(random);
        }
    isa_cost::triangle triangles[64];
    for (auto& t : triangles)
        for (int k = 0; k < 3; ++k) {
            t.corner[k] = number(random);
            t.edge[0][k] = number(random);
            t.edge[1][k] = number(random);
        }
    double sum = 0;
    long hits = 0;
    auto start = std::chrono::steady_clock::now();
    for (long i = 0; i < packets; ++i) {
        if (i % 64 == 0)
            for (float& t : r.far_t)
                t = 100.0F;
        for (int at = 0; at < 32; at += ISA_COST_WIDTH)
            hits += kernel(triangles[i % 64], r, at) ? 1 : 0;
    }
    std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    for (int lane = 0; lane < 32; ++lane)
        sum += static_cast<double>(r.far_t[lane]) + static_cast<double>(r.u[lane]) + static_cast<double>(r.v[lane]);
    std::printf("%s %s: %.1f ns a packet, %ld packets hit, sum %.9g\n", argv[1], argv[2],
                took.count() / static_cast<double>(packets), hits, sum);
    return 0;
}
