// math_error TARGET [STRIDE]: the largest error of every elementary function over all floats (or every STRIDE-th),
// beside its stated bound; of pow and atan2 over a 61st of those, with some second arguments. Exits with 1 where a
// bound is exceeded.
#include "math_targets.h"

#include "isa/cpu.h"

#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace {

using namespace isa_test;

struct worst {
    double ulp = 0;
    float at = 0;
};

template <class Exact> worst scan(array_function f, std::uint64_t stride, float domain, float y, Exact exact) {
    constexpr std::size_t block = 4096;
    std::vector<float> x(block), ys(block, y), r(block);
    worst w;
    for (std::uint64_t next = 0; next < 1ULL << 32;) {
        for (float& v : x) {
            v = std::bit_cast<float>(static_cast<std::uint32_t>(next));
            next += stride;
        }
        f(x.data(), ys.data(), r.data(), int{block});
        for (std::size_t i = 0; i < block; ++i) {
            double e = std::abs(x[i]) <= domain ? exact(static_cast<double>(x[i])) : std::nan("");
            double error = ulp_error(r[i], e);
            if (error > w.ulp)
                w = {error, x[i]};
        }
    }
    return w;
}

int report(const char* name, const worst& w, double bound) {
    std::printf("%-12s %8.4f ulp at %.9g (bound %.2f)%s\n", name, w.ulp, static_cast<double>(w.at), bound,
                w.ulp <= bound ? "" : "  EXCEEDED");
    std::fflush(stdout);
    return w.ulp <= bound ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
    std::string_view wanted = argc > 1 ? argv[1] : "";
    std::uint64_t stride = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
    for (const math_target& t : math_targets) {
        if (wanted != t.name || stride == 0 || !isa::cpu_runs(wanted))
            continue;
        int failed = 0;
        for (const math_function& f : t.functions()) {
            for (const math_bound& b : math_bounds)
                if (std::string_view(f.name) == b.name)
                    failed |= report(f.name, scan(f.vectors, stride, b.domain, 0.0F, b.exact), b.ulp);
            const auto with = [&](float y, double (*exact)(double, double), double bound) {
                const auto of_x = [&](double x) { return exact(x, static_cast<double>(y)); };
                const worst w = scan(f.vectors, 61 * stride, std::numeric_limits<float>::infinity(), y, of_x);
                char name[32];
                std::snprintf(name, sizeof name, "%s(x,%g)", f.name, static_cast<double>(y));
                failed |= report(name, w, bound);
            };
            if (std::string_view(f.name) == "pow")
                for (float y : {-1.7F, -0.01F, 0.5F, 1.0F, 2.0F, 2.2F, 50.3F, -212.5F, 255.0F, 1000.0F, 1e6F})
                    with(
                        y, [](double a, double b) { return a < 0 ? std::nan("") : std::pow(a, b); }, pow_bound);
            if (std::string_view(f.name) == "atan2")
                for (float y : {1e-30F, 0.01F, 0.7F, 1.0F, 1234.5F, -1e-30F, -0.01F, -0.7F, -1.0F, -1234.5F})
                    with(
                        y, [](double a, double b) { return std::atan2(a, b); }, atan2_bound);
        }
        return failed;
    }
    std::fprintf(stderr,
                 "usage: math_error TARGET [STRIDE], with a target that was built and that this processor runs\n");
    return 2;
}
