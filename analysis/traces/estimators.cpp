#include "analysis/traces/estimators.h"

#include "analysis/traces/lru_curve.h"
#include "analysis/traces/sampled_curve.h"
#include "analysis/traces/set_curve.h"
#include "traces/sample.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

namespace analysis {
namespace {

/// Uniform in [0, 1), of a number and a seed.
double chance(std::uint64_t number, std::uint64_t seed) {
    return traces::hash_of_line(number + seed * 0xD1B54A32D192ED03U);
}

double ratio_of(double misses, double touches) {
    return touches > 0 ? misses / touches : std::numeric_limits<double>::quiet_NaN();
}

/// Caches of all sizes, fully associative or of sets.
class Caches {
public:
    Caches(const std::vector<std::uint64_t>& sizes, std::uint64_t ways) : sizes_(sizes), ways_(ways) {
        empty();
    }
    /// `counts`: else caches merely learn of it.
    void touch(std::uint64_t line, bool counts) {
        const std::size_t group = counts ? 0 : 1;
        if (lru_)
            lru_->touch(line, group);
        for (SetCurve& one : sets_)
            one.touch(line, group);
        touches_ += counts ? 1 : 0;
    }
    /// They hold nothing; what they counted stays.
    void empty() {
        for (std::size_t s = 0; s < misses_.size(); ++s)
            misses_[s] = misses(s);
        misses_.resize(sizes_.size(), 0);
        sets_.clear();
        if (ways_ == 0)
            lru_.emplace(sizes_);
        else
            for (const std::uint64_t size : sizes_)
                sets_.emplace_back(size / ways_, std::vector<std::uint64_t>{ways_});
    }
    std::uint64_t misses(std::size_t size) const {
        return misses_[size] + (lru_ ? lru_->counts().misses(0, size) : sets_[size].counts().misses(0, 0));
    }
    std::uint64_t touches() const { return touches_; }

private:
    std::vector<std::uint64_t> sizes_;
    std::uint64_t ways_, touches_ = 0;
    std::vector<std::uint64_t> misses_; // of caches that were emptied
    std::optional<LruCurve> lru_;
    std::vector<SetCurve> sets_; // by size
};

class All final : public MissEstimator {
public:
    All(const std::vector<std::uint64_t>& sizes, std::uint64_t ways) : caches_(sizes, ways) {}
    void touch(std::span<const std::uint64_t> lines) override {
        for (const std::uint64_t line : lines)
            caches_.touch(line, true);
    }
    double ratio(std::size_t size) const override {
        return ratio_of(static_cast<double>(caches_.misses(size)), static_cast<double>(caches_.touches()));
    }
    std::uint64_t looked_at() const override { return caches_.touches(); }

private:
    Caches caches_;
};

class OfLines final : public MissEstimator {
public:
    OfLines(const std::vector<std::uint64_t>& sizes, const Sampling& s)
        : curve_(sizes, s.share, 1, s.most_lines, s.seed) {}
    void touch(std::span<const std::uint64_t> lines) override { curve_.touch(lines, 0); }
    double ratio(std::size_t size) const override {
        return curve_.lines().references(0) == 0 ? ratio_of(0, 0) : curve_.estimate(0, size).ratio;
    }
    std::uint64_t looked_at() const override { return curve_.lines().sampled(); }

private:
    SampledCurve curve_;
};

/// One window of each 1 / share, at a place that chance says.
class OfWindows final : public MissEstimator {
public:
    OfWindows(const std::vector<std::uint64_t>& sizes, std::uint64_t ways, const Sampling& s)
        : sampling_(s), caches_(sizes, ways),
          warm_(static_cast<std::uint64_t>(std::ceil(s.warm_up * static_cast<double>(s.window)))) {
        choose();
    }
    void touch(std::span<const std::uint64_t> lines) override {
        while (!lines.empty()) {
            const std::uint64_t begin = chosen_ * sampling_.window, end = begin + sampling_.window;
            if (now_ < begin) {
                const auto skipped =
                    static_cast<std::size_t>(std::min<std::uint64_t>(lines.size(), begin - now_));
                now_ += skipped;
                lines = lines.subspan(skipped);
                continue;
            }
            const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(lines.size(), end - now_));
            for (const std::uint64_t line : lines.first(n)) {
                caches_.touch(line, now_ - begin >= warm_);
                ++now_;
            }
            looked_at_ += n;
            lines = lines.subspan(n);
            if (now_ == end) {
                ++number_;
                choose();
                if (!sampling_.keep)
                    caches_.empty();
            }
        }
    }
    double ratio(std::size_t size) const override {
        return ratio_of(static_cast<double>(caches_.misses(size)), static_cast<double>(caches_.touches()));
    }
    std::uint64_t looked_at() const override { return looked_at_; }

private:
    /// Window `number_` of those that are looked at, among the ones that follow the stretch of the one
    /// before.
    void choose() {
        const auto first_of = [&](std::uint64_t number) {
            return static_cast<std::uint64_t>(
                std::ceil(static_cast<double>(number) / sampling_.share - 1e-9));
        };
        const std::uint64_t first = first_of(number_), next = first_of(number_ + 1);
        chosen_ = first + static_cast<std::uint64_t>(chance(number_, sampling_.seed) *
                                                     static_cast<double>(next - first));
    }

    Sampling sampling_;
    Caches caches_;
    std::uint64_t warm_, now_ = 0, number_ = 0, chosen_ = 0, looked_at_ = 0;
};

/// Some sets of each cache: what they miss of what they are asked for.
class OfSets final : public MissEstimator {
public:
    OfSets(const std::vector<std::uint64_t>& sizes, std::uint64_t ways, const Sampling& s) {
        for (const std::uint64_t size : sizes) {
            const std::uint64_t sets = size / ways;
            std::vector<std::pair<double, std::uint32_t>> order;
            for (std::uint64_t set = 0; set < sets; ++set)
                order.emplace_back(chance(set, s.seed), static_cast<std::uint32_t>(set));
            const auto some = static_cast<std::size_t>(
                std::clamp(std::round(s.share * static_cast<double>(sets)), 1.0, static_cast<double>(sets)));
            std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(some - 1),
                             order.end());
            One& one = caches_.emplace_back(sets, SetCurve(some, {ways}), std::vector<std::uint32_t>());
            one.place.assign(sets, none);
            for (std::size_t i = 0; i < some; ++i)
                one.place[order[i].second] = static_cast<std::uint32_t>(i);
        }
    }
    void touch(std::span<const std::uint64_t> lines) override {
        for (One& one : caches_) // each of which is small enough to stay in fast memory, one after the other
            for (const std::uint64_t line : lines) {
                const std::uint64_t set = one.whole_power ? line & (one.sets - 1) : line % one.sets;
                const std::uint32_t place = one.place[static_cast<std::size_t>(set)];
                if (place != none) // a line of the set that this one is among those that are looked at
                    one.curve.touch(line / one.sets * one.curve.sets() + place, 0);
            }
    }
    double ratio(std::size_t size) const override {
        const ReuseCounts& counts = caches_[size].curve.counts();
        return ratio_of(static_cast<double>(counts.misses(0, 0)), static_cast<double>(counts.references(0)));
    }
    std::uint64_t looked_at() const override {
        std::uint64_t out = 0;
        for (const One& one : caches_)
            out += one.curve.counts().references(0);
        return out / caches_.size();
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    struct One {
        One(std::uint64_t n, SetCurve c, std::vector<std::uint32_t> p)
            : sets(n), whole_power(std::has_single_bit(n)), curve(std::move(c)), place(std::move(p)) {}
        std::uint64_t sets;
        bool whole_power; // of two: a division for each touch would cost more than all else
        SetCurve curve;
        std::vector<std::uint32_t> place; // among the sets that are looked at, by set
    };
    std::vector<One> caches_; // by size
};

} // namespace

std::unique_ptr<MissEstimator> make_estimator(const std::vector<std::uint64_t>& sizes, std::uint64_t ways,
                                              const Sampling& sampling) {
    const bool whole = ways == 0 || std::all_of(sizes.begin(), sizes.end(),
                                                [&](std::uint64_t size) { return size % ways == 0; });
    if (!whole)
        throw std::invalid_argument("a cache has no whole number of sets; choose other sizes or ways");
    switch (sampling.method) {
    case SamplingMethod::exact:
        return std::make_unique<All>(sizes, ways);
    case SamplingMethod::lines:
        if (ways != 0)
            throw std::invalid_argument("samples of lines tell of fully associative caches alone; write ways "
                                        "= 0, or another method");
        return std::make_unique<OfLines>(sizes, sampling);
    case SamplingMethod::windows:
        return std::make_unique<OfWindows>(sizes, ways, sampling);
    case SamplingMethod::sets:
        break;
    }
    if (ways == 0)
        throw std::invalid_argument("fully associative caches have one set; write ways = N, at least 1");
    return std::make_unique<OfSets>(sizes, ways, sampling);
}

} // namespace analysis
