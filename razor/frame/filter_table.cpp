#include "razor/frame/filter_table.h"

#include "razor/scene/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace razor {
namespace {

/// Between two zeros, or the filter's ends.
struct Lobe {
    double begin, end;
    std::vector<double> integral; // of the absolute value, from `begin` to each of so many even steps
    bool negative = false;
    int bins = 1;

    double mass() const { return integral.back(); }
};

constexpr int steps = 1024; // of a lobe: Simpson's rule leaves errors of about 1e-12

double simpson(const Filter& f, int axis, double a, double b) {
    return (filter_at(f, axis, a) + 4 * filter_at(f, axis, 0.5 * (a + b)) + filter_at(f, axis, b)) * (b - a) /
           6;
}

Lobe lobe_between(const Filter& f, int axis, double begin, double end) {
    Lobe lobe{begin, end, {0.0}};
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        lobe.integral.push_back(sum += simpson(f, axis, begin + (end - begin) * i / steps,
                                               begin + (end - begin) * (i + 1) / steps));
    lobe.negative = sum < 0;
    if (lobe.negative)
        for (double& part : lobe.integral)
            part = -part;
    return lobe;
}

/// Zeros further apart than 1/2048 of the filter are found.
std::vector<Lobe> lobes_of(const Filter& f, int axis) {
    constexpr int looks = 4096;
    const double radius = f.radius[axis];
    const auto sign = [&](double x) { return filter_at(f, axis, x) < 0; };
    std::vector<Lobe> lobes;
    double begin = -radius;
    double last = begin + radius / looks; // at its very ends the filter may be 0
    for (int i = 1; i < looks; ++i) {
        const double here = radius * (2 * (i + 0.5) / looks - 1);
        if (sign(here) != sign(last)) {
            double low = last, high = here;
            for (int n = 0; n < 60; ++n) {
                const double middle = 0.5 * (low + high);
                (sign(middle) == sign(here) ? high : low) = middle;
            }
            lobes.push_back(lobe_between(f, axis, begin, high));
            begin = high;
        }
        last = here;
    }
    lobes.push_back(lobe_between(f, axis, begin, radius));
    return lobes;
}

/// As many bins as a lobe has of the whole, one at least.
void share_bins(std::vector<Lobe>& lobes) {
    double left = 0;
    for (const Lobe& lobe : lobes)
        left += lobe.mass();
    int bins = filter_bins;
    std::vector<Lobe*> order;
    for (Lobe& lobe : lobes)
        order.push_back(&lobe);
    std::sort(order.begin(), order.end(), [](const Lobe* a, const Lobe* b) { return a->mass() < b->mass(); });
    for (std::size_t i = 0; i < order.size(); ++i) { // the largest takes what is left
        const auto others = static_cast<int>(order.size() - i) - 1;
        const double wanted = left > 0 ? bins * order[i]->mass() / left : 0;
        order[i]->bins = std::clamp(static_cast<int>(std::lround(wanted)), 1, bins - others);
        left -= order[i]->mass();
        bins -= order[i]->bins;
    }
}

/// Where the integral from the lobe's begin is that part of all of it.
double place_of(const Filter& f, int axis, const Lobe& lobe, double part) {
    const double wanted = part * lobe.mass();
    const auto after = std::upper_bound(lobe.integral.begin(), lobe.integral.end(), wanted);
    const auto i = std::clamp<std::ptrdiff_t>(after - lobe.integral.begin() - 1, 0, steps - 1);
    const double before = lobe.integral[static_cast<std::size_t>(i)];
    const double from = lobe.begin + (lobe.end - lobe.begin) * static_cast<double>(i) / steps;
    double low = from, high = lobe.begin + (lobe.end - lobe.begin) * static_cast<double>(i + 1) / steps;
    for (int n = 0; n < 48; ++n) {
        const double middle = 0.5 * (low + high);
        (before + std::abs(simpson(f, axis, from, middle)) < wanted ? low : high) = middle;
    }
    return high;
}

} // namespace

FilterTable tabulate(const Filter& filter) {
    FilterTable table;
    for (int axis = 0; axis < 2; ++axis) {
        std::vector<Lobe> lobes = lobes_of(filter, axis);
        double absolute = 0, all = 0;
        for (const Lobe& lobe : lobes) {
            absolute += lobe.mass();
            all += lobe.negative ? -lobe.mass() : lobe.mass();
        }
        if (static_cast<int>(lobes.size()) > filter_bins / 8)
            throw UserError("the filter is positive and negative too many times; give a smaller radius");
        if (!(all > 0.1 * absolute))
            throw UserError("the filter's negative parts outweigh what it lets through; give another radius");
        share_bins(lobes);
        for (const Lobe& lobe : lobes) {
            double from = lobe.begin;
            const double weight = lobe.mass() / lobe.bins * filter_bins / all;
            for (int i = 1; i <= lobe.bins; ++i) {
                const double to =
                    i == lobe.bins ? lobe.end : place_of(filter, axis, lobe, double(i) / lobe.bins);
                // A pixel's middle is half a pixel from its corner, where its samples are counted from.
                table.bins.push_back({static_cast<float>(from + 0.5), static_cast<float>(to - from),
                                      static_cast<float>(lobe.negative ? -weight : weight), 0});
                from = to;
            }
            table.weighted = table.weighted || lobe.negative;
        }
    }
    return table;
}

} // namespace razor
