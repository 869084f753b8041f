#include "razor/frame/counters.h"

namespace razor {

Counters& Counters::operator+=(const Counters& o) {
    static_assert(sizeof(Counters) % sizeof(std::int64_t) == 0);
    auto* to = reinterpret_cast<std::int64_t*>(this);
    const auto* from = reinterpret_cast<const std::int64_t*>(&o);
    for (std::size_t i = 0; i < sizeof(Counters) / sizeof(std::int64_t); ++i)
        to[i] += from[i];
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

} // namespace razor
