// Groups of GPU threads on a CPU, with warps of 32 lanes. Tests take them where there is no GPU.
#pragma once
#include <bit>
#include <cmath>

namespace emulated {
const int LANES = 32;
}

#ifdef THREADS
#include "threads.h"
#else
#include "fibers.h"
#endif

#define __device__
#define __forceinline__ inline

inline const struct {
    struct {
        operator int() const { return emulated::current_thread(); }
    } x;
} threadIdx;
inline const struct {
    struct {
        operator int() const { return emulated::threads_of_group(); }
    } x;
} blockDim;

inline void __syncthreads() { emulated::wait_for_group(); }
inline void __syncwarp() { emulated::wait_for_warp(); }

template <class T> T __shfl_xor_sync(unsigned, T x, int distance) {
    std::vector<long long>& exchanged = emulated::exchanged();
    const int here = threadIdx.x;
    exchanged[here] = std::bit_cast<long long>(x);
    emulated::wait_for_warp();
    T other = std::bit_cast<T>(exchanged[here ^ distance]);
    emulated::wait_for_warp();
    return other;
}

inline int __clzll(long long x) { return std::countl_zero((unsigned long long)x); }
inline long long __double_as_longlong(double x) { return std::bit_cast<long long>(x); }
inline double __longlong_as_double(long long x) { return std::bit_cast<double>(x); }
using std::fabs;
using std::sqrt;
using std::trunc;
