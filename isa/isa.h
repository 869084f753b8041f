// The wide-SIMD vocabulary, for the target this file is compiled for. Kernels include this and nothing of isa/ besides
// (isa/math.h for log, exp, sin, cos, pow). See isa/README.md for a kernel to copy from.
#pragma once

#include "isa/target.h"

#if defined(ISA_TARGET_SIMULATED)
#include "isa/simulated/memory.h"
#else
#include "isa/native/memory.h"
#endif
