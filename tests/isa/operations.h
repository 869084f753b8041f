// The cases of the operation tests. Every target and width compiles the same cases (operations_cases.cpp);
// each reads its operands from an `operands` and writes its result to a `result` as plain bits, so that those
// of one target can be compared with those of another.
#pragma once

#include <cstdint>

namespace isa_test {

inline constexpr int most_lanes = 64;
inline constexpr int room = most_lanes + 16; // loads may begin after lane 0

/// Lanes beyond the width are not used. Scalar operations take each lane in turn; where one meets a vector, its operand
/// is lane 0.
struct operands {
    alignas(64) float a[room], b[room], c[room];
    alignas(64) std::int32_t i[room], j[room];
    alignas(64) std::int32_t m[room], n[room]; // masks, as 0 and 1
};

enum class kind { floats, integers };

/// What a case computed: its first `count` words.
struct result {
    alignas(64) std::uint32_t word[4 * most_lanes];
    int count;
    kind is;
};

/// What a case depends on, so that no case runs over operands it does not have.
enum class shape { floats_1, floats_2, floats_3, integers_2, masks, mixed };

struct operation {
    const char* name;
    shape takes;
    /// On sse4 the same as with two roundings, sign * (a*b) + sign_c * c: 0 where nothing is fused.
    int sign, sign_c;
    void (*run)(const operands&, result&);
};

struct operation_list {
    const operation* begin;
    int count;
    int width;
    /// One masked load from p, or store to it, of the lanes whose m is not 0.
    void (*masked_load)(const float* p, const std::int32_t* m, float* to);
    void (*masked_store)(float* p, const std::int32_t* m, const float* from);
};

} // namespace isa_test
