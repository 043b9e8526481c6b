// Sums and maxima over the lanes of a warp.
#pragma once
#include "target.h"

FN i64 warp_sum(i64 x) {
#pragma unroll
    for (int d = WARP / 2; d > 0; d /= 2) x += __shfl_xor_sync(ALL_LANES, x, d);
    return x;
}

FN double warp_max(double x) {
#pragma unroll
    for (int d = WARP / 2; d > 0; d /= 2) x = larger(x, __shfl_xor_sync(ALL_LANES, x, d));
    return x;
}

// Eight sums at once: at each of three levels a lane keeps half of the sums that it has and hands over the
// others, which takes 9 exchanges in place of 40. Lane l ends up with sum number l / 4.
FN i64 warp_sums(i64 (&sums)[8]) {
    int lane = threadIdx.x % WARP;
#pragma unroll
    for (int half = 4, d = WARP / 2; half > 0; half /= 2, d /= 2) {
        bool keeps_upper = lane & d;
#pragma unroll
        for (int k = 0; k < 4; k++) {
            if (k < half) {
                i64 kept = keeps_upper ? sums[k + half] : sums[k], given = keeps_upper ? sums[k] : sums[k + half];
                sums[k] = kept + __shfl_xor_sync(ALL_LANES, given, d);
            }
        }
    }
    sums[0] += __shfl_xor_sync(ALL_LANES, sums[0], 2);
    sums[0] += __shfl_xor_sync(ALL_LANES, sums[0], 1);
    return sums[0];
}
