// Which target this translation unit is compiled for. The build passes
//   ISA_TARGET          the namespace of the target: plain, sse4, avx2, avx512 or simulated
//   ISA_TARGET_<NAME>=1 the same, for the preprocessor
//   ISA_WIDTH           logical lanes of a vector: 8, 16, 32 or 64
//   ISA_VALUES_<NAME>=1 for `simulated` only: the native header its values come from (plain, avx2 or avx512)
// Everything a kernel defines sits in a namespace named by ISA_TARGET, so that one program can hold all of them.
#pragma once

#if !defined(ISA_TARGET) || !defined(ISA_WIDTH)
#error "kernels are compiled through razor_kernels() or isa_configure() (isa/cmake/targets.cmake)"
#endif
#if ISA_WIDTH != 8 && ISA_WIDTH != 16 && ISA_WIDTH != 32 && ISA_WIDTH != 64
#error "ISA_WIDTH must be 8, 16, 32 or 64"
#endif

// The namespace that holds the native vocabulary of this translation unit. A simulated one keeps its values' type in a
// namespace of its own: code compiled with two sets of flags never shares a symbol.
#if defined(ISA_TARGET_SIMULATED)
#define ISA_NATIVE isa::simulated::values
#else
#define ISA_NATIVE isa::ISA_TARGET
#endif

#if defined(ISA_TARGET_AVX512) || defined(ISA_VALUES_AVX512)
#define ISA_REGISTERS "isa/native/registers_avx512.h"
#elif defined(ISA_TARGET_AVX2) || defined(ISA_VALUES_AVX2)
#define ISA_REGISTERS "isa/native/registers_avx2.h"
#elif defined(ISA_TARGET_SSE4)
#define ISA_REGISTERS "isa/native/registers_sse4.h"
#elif defined(ISA_TARGET_PLAIN) || defined(ISA_VALUES_PLAIN)
#define ISA_REGISTERS "isa/native/registers_plain.h"
#else
#error "unknown ISA_TARGET"
#endif

namespace isa {
inline constexpr int width = ISA_WIDTH;
}
