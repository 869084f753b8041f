#include "tests/robustness/pairwise.h"

#include <array>
#include <cstddef>
#include <numeric>
#include <random>
#include <set>
#include <utility>

namespace razor::test {

namespace {

using Pair = std::array<int, 4>; // factor, value, later factor, value

class Cover {
public:
    explicit Cover(const std::vector<int>& values) : values_(values), random_(1) {
        const auto n = static_cast<int>(values.size());
        for (int f = 0; f < n; ++f)
            for (int g = f + 1; g < n; ++g)
                for (int a = 0; a < count(f); ++a)
                    for (int b = 0; b < count(g); ++b)
                        left_.insert({f, a, g, b});
    }
    bool done() const { return left_.empty(); }

    /// The best of some cases that each begin with a pair not yet tried and go on value by value.
    std::vector<int> next() {
        std::vector<int> best;
        std::size_t most = 0;
        for (int candidate = 0; candidate < 100; ++candidate) {
            std::vector<int> c = fill();
            const std::size_t gain = tried(c).size();
            if (gain > most) {
                most = gain;
                best = std::move(c);
            }
        }
        for (const Pair& p : tried(best))
            left_.erase(p);
        return best;
    }

private:
    int count(int factor) const { return values_[static_cast<std::size_t>(factor)]; }
    std::size_t pick(std::size_t n) { return static_cast<std::size_t>(random_()) % n; }

    std::vector<Pair> tried(const std::vector<int>& c) const {
        std::vector<Pair> pairs;
        const auto n = static_cast<int>(c.size());
        for (int f = 0; f < n; ++f)
            for (int g = f + 1; g < n; ++g) {
                const Pair p{f, c[static_cast<std::size_t>(f)], g, c[static_cast<std::size_t>(g)]};
                if (left_.count(p) > 0)
                    pairs.push_back(p);
            }
        return pairs;
    }

    std::vector<int> fill() {
        const auto n = static_cast<int>(values_.size());
        std::vector<int> c(values_.size(), -1);
        auto first = left_.begin();
        std::advance(first, static_cast<std::ptrdiff_t>(pick(left_.size())));
        c[static_cast<std::size_t>((*first)[0])] = (*first)[1];
        c[static_cast<std::size_t>((*first)[2])] = (*first)[3];
        std::vector<int> order(values_.size());
        std::iota(order.begin(), order.end(), 0);
        for (std::size_t i = order.size(); i > 1; --i)
            std::swap(order[i - 1], order[pick(i)]);
        for (const int f : order) {
            if (c[static_cast<std::size_t>(f)] >= 0)
                continue;
            std::vector<int> bests;
            int most = -1;
            for (int a = 0; a < count(f); ++a) {
                int gain = 0;
                for (int g = 0; g < n; ++g) {
                    const int b = c[static_cast<std::size_t>(g)];
                    if (b >= 0 && g != f)
                        gain += static_cast<int>(left_.count(f < g ? Pair{f, a, g, b} : Pair{g, b, f, a}));
                }
                if (gain > most) {
                    most = gain;
                    bests.clear();
                }
                if (gain == most)
                    bests.push_back(a);
            }
            c[static_cast<std::size_t>(f)] = bests[pick(bests.size())];
        }
        return c;
    }

    std::vector<int> values_;
    std::set<Pair> left_;
    std::mt19937 random_;
};

} // namespace

std::vector<std::vector<int>> pairwise_cases(const std::vector<int>& values) {
    Cover cover(values);
    std::vector<std::vector<int>> cases;
    while (!cover.done())
        cases.push_back(cover.next());
    return cases;
}

} // namespace razor::test
