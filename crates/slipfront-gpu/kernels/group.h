// A group of threads, which finds sums and maxima over its blocks.
#pragma once
#include "block.h"
#include "warp.h"

static const int MAX_WARPS = 32;

// What the threads of a group share beside blocks: sums and maxima of their warps.
struct Shared {
    Step step;
    i64 sums[8][MAX_WARPS], energies[3][MAX_WARPS];
    double stress_square[MAX_WARPS], speed_square[MAX_WARPS], measured[6][MAX_WARPS];
};

// Index differences from a block to its neighbours.
struct Neighbours {
    int east, west, north, south;
};

FN Vec2 displacement_of(const double* ux, const double* uy, int b) {
    Vec2 u = {ux[b], uy[b]};
    return u;
}

FN Around around(const double* ux, const double* uy, int b, Neighbours to) {
    Around a;
    a.here = displacement_of(ux, uy, b);
    a.neighbours[EAST] = displacement_of(ux, uy, b + to.east);
    a.neighbours[WEST] = displacement_of(ux, uy, b + to.west);
    a.neighbours[NORTH] = displacement_of(ux, uy, b + to.north);
    a.neighbours[SOUTH] = displacement_of(ux, uy, b + to.south);
    a.neighbours[NORTH_EAST] = displacement_of(ux, uy, b + to.north + to.east);
    a.neighbours[NORTH_WEST] = displacement_of(ux, uy, b + to.north + to.west);
    a.neighbours[SOUTH_EAST] = displacement_of(ux, uy, b + to.south + to.east);
    a.neighbours[SOUTH_WEST] = displacement_of(ux, uy, b + to.south + to.west);
    return a;
}

FN void measure_block(u32 flags, const Around& a, Measured& m) {
    double extent[4] = {a.here.x, -a.here.x, a.here.y, -a.here.y};
    for (int k = 0; k < 4; k++) m.largest[k] = larger(m.largest[k], extent[k]);
    // Each spring has one of these directions from one of its ends.
    for (int k = EAST; k <= NORTH_WEST; k++) {
        if (!(flags >> k & 1)) continue;
        Vec2 difference = a.neighbours[k] - a.here;
        m.largest[4] = larger(m.largest[4], fabs(difference.x));
        m.largest[5] = larger(m.largest[5], fabs(difference.y));
    }
}

FN Words over_lanes(Words words) {
    words.low = warp_sum(words.low);
    words.high = warp_sum(words.high);
    return words;
}

// Shares the maxima of each warp.
FN void share_measured(const Measured& m, Shared& shared) {
    int warp = threadIdx.x / WARP, lane = threadIdx.x % WARP;
    for (int k = 0; k < 6; k++) {
        double most = warp_max(m.largest[k]);
        if (lane == 0) shared.measured[k][warp] = most;
    }
}

// The first warp finds the largest of the maxima of the warps.
FN Measured join_measured(const Shared& shared) {
    int lane = threadIdx.x, warps = blockDim.x / WARP;
    Measured m = nothing_measured();
    for (int k = 0; k < 6; k++) m.largest[k] = warp_max(lane < warps ? shared.measured[k][lane] : m.largest[k]);
    return m;
}

// Shares the sums of each warp.
template <bool ENERGY> FN void share_sums(const Sums& s, Shared& shared) {
    int warp = threadIdx.x / WARP, lane = threadIdx.x % WARP;
    i64 sums[8] = {s.displacement[0], s.displacement[1], s.velocity[0],  s.velocity[1],
                   s.motion_square,   s.friction_work,   s.counts, 0};
    i64 sum = warp_sums(sums);
    double stress_square = warp_max(s.stress_square), speed_square = warp_max(s.speed_square);
    if (lane % 4 == 0) shared.sums[lane / 4][warp] = sum;
    if (lane == 0) {
        shared.stress_square[warp] = stress_square;
        shared.speed_square[warp] = speed_square;
    }
    if (ENERGY) {
        i64 energies[3] = {s.velocity_squares, s.displacement_square, s.lattice_energy};
        for (int k = 0; k < 3; k++) {
            i64 energy = warp_sum(energies[k]);
            if (lane == 0) shared.energies[k][warp] = energy;
        }
    }
}

// The first warp finds the sums over all blocks of the group from those of the warps.
FN Totals join_sums(const Shared& shared) {
    int lane = threadIdx.x, warps = blockDim.x / WARP;
    Totals t = no_totals();
    for (int k = 0; k < VELOCITY_SQUARES; k++) t.sums[k] = over_lanes(words_of(lane < warps ? shared.sums[k][lane] : 0));
    i64 counts = lane < warps ? shared.sums[VELOCITY_SQUARES][lane] : 0;
    t.sliding = (u32)warp_sum(counts & 0xffff);
    t.slipping = (u32)warp_sum(counts >> 16);
    if (shared.step.has_energies) {
        for (int k = VELOCITY_SQUARES; k < SUMS; k++) {
            t.sums[k] = over_lanes(words_of(lane < warps ? shared.energies[k - VELOCITY_SQUARES][lane] : 0));
        }
    }
    t.stress_square = warp_max(lane < warps ? shared.stress_square[lane] : 0.0);
    t.speed_square = warp_max(lane < warps ? shared.speed_square[lane] : 0.0);
    if (shared.step.measures) t.measured = join_measured(shared);
    return t;
}

// Takes blocks first, first + stride, ... into the weakening energy of their lattice: finds the largest term, or adds
// the terms, once all threads have found the largest. A warp adds at most 2^11 terms.
template <bool LARGEST> FN void add_weakening(Lattice& lattice, const double* memory, size_t first, size_t stride) {
    CommonSum& sum = lattice.weakening_energy;
    const size_t n = lattice.n;
    const double shift = LARGEST ? 0.0 : shift_of(limit_of(of_bits((i64)sum.largest)));
    double largest = 0.0;
    i64 terms = 0;
#pragma unroll 1
    for (size_t b = first; b < n; b += stride) {
        double energy = weakening_energy_of(lattice.equations, memory, n, b);
        if (LARGEST) largest = larger(largest, energy);
        else terms += integer_of(energy, shift);
    }
    if (LARGEST) largest = warp_max(largest);
    else terms = warp_sum(terms);
    if (threadIdx.x % WARP != 0) return;
    if (LARGEST) {
        atomicMax(&sum.largest, (u64)bits_of(largest));
    } else {
        Words words = words_of(terms);
        atomicAdd(&sum.low, (u64)words.low);
        atomicAdd(&sum.high, (u64)words.high);
    }
}

FN void add_totals(Totals& sum, const Totals& t) {
    for (int k = 0; k < SUMS; k++) {
        sum.sums[k].low += t.sums[k].low;
        sum.sums[k].high += t.sums[k].high;
    }
    sum.sliding += t.sliding;
    sum.slipping += t.slipping;
    sum.stress_square = larger(sum.stress_square, t.stress_square);
    sum.speed_square = larger(sum.speed_square, t.speed_square);
    for (int k = 0; k < 6; k++) sum.measured.largest[k] = larger(sum.measured.largest[k], t.measured.largest[k]);
}

FN Totals totals_over_lanes(Totals t) {
    for (int k = 0; k < SUMS; k++) t.sums[k] = over_lanes(t.sums[k]);
    t.sliding = (u32)warp_sum((i64)t.sliding);
    t.slipping = (u32)warp_sum((i64)t.slipping);
    t.stress_square = warp_max(t.stress_square);
    t.speed_square = warp_max(t.speed_square);
    for (int k = 0; k < 6; k++) t.measured.largest[k] = warp_max(t.measured.largest[k]);
    return t;
}
