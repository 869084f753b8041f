// The two types of word in frame memory that are more than plain data. Same layout on every target; shared by host code
// and kernels.
#pragma once

#include <cstdint>

namespace isa {

/// A reference to a T elsewhere in frame memory: the distance in bytes from this word to the T. 0 is null. Meaningful
/// only in place: copy it by load and store of pointer<T>, never as bytes.
template <class T> struct ref {
    std::int64_t distance = 0;

    /// Host side only; kernels use load and store.
    [[gnu::always_inline]] void set(T* target) {
        distance =
            target == nullptr ? 0 : reinterpret_cast<std::intptr_t>(target) - reinterpret_cast<std::intptr_t>(this);
    }
    [[gnu::always_inline]] T* get() const {
        auto self = reinterpret_cast<std::intptr_t>(this);
        return distance == 0 ? nullptr : reinterpret_cast<T*>(self + static_cast<std::intptr_t>(distance));
    }
};

/// A word that several workers may write while others read it: node states, queue heads, locks. Reachable only through
/// the atomic operations of the vocabulary. Everything else that workers share is written once, before it is published.
template <class T> struct shared {
    static_assert(sizeof(T) == 4, "shared words are 32 bits");
    T word{};
};

} // namespace isa
