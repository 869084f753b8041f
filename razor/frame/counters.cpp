#include "razor/frame/counters.h"

#include <functional>

namespace razor {
namespace {

template <class Combine> void combine(Counters& a, const Counters& b, Combine combine) {
    static_assert(sizeof(Counters) % sizeof(std::int64_t) == 0);
    auto* to = reinterpret_cast<std::int64_t*>(&a);
    const auto* from = reinterpret_cast<const std::int64_t*>(&b);
    for (std::size_t i = 0; i < sizeof(Counters) / sizeof(std::int64_t); ++i)
        to[i] = combine(to[i], from[i]);
}

} // namespace

Counters& Counters::operator+=(const Counters& o) {
    combine(*this, o, std::plus<>());
    return *this;
}

Counters& Counters::operator-=(const Counters& o) {
    combine(*this, o, std::minus<>());
    return *this;
}

Counters CountersByKind::sum() const {
    Counters all;
    for (const Counters& c : kind)
        all += c;
    return all;
}

CountersByKind& CountersByKind::operator+=(const CountersByKind& o) {
    for (int k = 0; k < kind_count; ++k)
        kind[k] += o.kind[k];
    return *this;
}

CountersByKind& CountersByKind::operator-=(const CountersByKind& o) {
    for (int k = 0; k < kind_count; ++k)
        kind[k] -= o.kind[k];
    return *this;
}

} // namespace razor
