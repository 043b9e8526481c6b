// Types and functions that kernels take from the compiler for a GPU, nvcc or NVRTC, or from emulate.h.
#pragma once
#ifdef EMULATED
#include "emulate.h"
#endif
#define FN __device__ __forceinline__
typedef unsigned short u16;
typedef unsigned int u32;
typedef unsigned long long u64;
typedef long long i64;

static const int WARP = 32;
static const u32 ALL_LANES = 0xffffffffu;

FN i64 bits_of(double x) { return __double_as_longlong(x); }
FN double of_bits(i64 x) { return __longlong_as_double(x); }
// `f64::max` of Rust for numbers of which none is NaN.
FN double larger(double a, double b) { return b > a ? b : a; }
