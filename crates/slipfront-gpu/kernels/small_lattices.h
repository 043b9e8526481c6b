// Many small lattices, each through many steps by a group of threads, with its blocks in their shared memory.
#pragma once
#include "block.h"
#include "warp.h"

static const int MAX_WARPS = 32;

// What the threads of a lattice share beside its blocks: sums of their warps.
struct Shared {
    Step step;
    i64 sums[8][MAX_WARPS], energies[3][MAX_WARPS];
    double stress_square[MAX_WARPS], speed_square[MAX_WARPS], measured[6][MAX_WARPS];
};

// Numbers of the blocks of a lattice; all but first slips in shared memory.
struct Blocks {
    double *ux, *uy, *vx, *vy, *limit_squares, *impulses;
    u32 *flags, *first_slips;
};

static const int BYTES_PER_BLOCK = 6 * 8 + 4;

FN Blocks blocks_in(double* memory, u32 n, u32* first_slips) {
    double* flags = memory + 6 * n;
    Blocks a = {memory,         memory + n,     memory + 2 * n, memory + 3 * n,
                memory + 4 * n, memory + 5 * n, (u32*)flags,    first_slips};
    return a;
}

// Steps from a block to its neighbours. One that lies beyond an edge is found at the other end of the lattice:
// there it is across a periodic edge, and else its spring is masked.
struct Neighbours {
    int east, west, north, south;
};

FN Neighbours neighbours_of(u32 flags, int nx, int n) {
    Neighbours to;
    to.east = flags & LAST_COLUMN ? 1 - nx : 1;
    to.west = flags & FIRST_COLUMN ? nx - 1 : -1;
    to.north = flags & LAST_ROW ? nx - n : nx;
    to.south = flags & FIRST_ROW ? n - nx : -nx;
    return to;
}

FN Vec2 displacement_of(const Blocks& a, int b) {
    Vec2 u = {a.ux[b], a.uy[b]};
    return u;
}

// Eq. 8.
FN void move_blocks(const Blocks& a, int n, double dt) {
    for (int b = threadIdx.x; b < n; b += blockDim.x) {
        a.ux[b] = a.ux[b] + dt * a.vx[b];
        a.uy[b] = a.uy[b] + dt * a.vy[b];
    }
}

// Extent of displacements and their differences along springs, see Bounds, over the blocks of a warp.
FN void measure_blocks(const Lattice& lattice, const Blocks& a, Shared& shared) {
    const double none = -of_bits(0x7ff0000000000000LL);
    double measured[6] = {none, none, none, none, 0.0, 0.0};
#pragma unroll 1
    for (int b = threadIdx.x; b < (int)lattice.n; b += blockDim.x) {
        u32 flags = a.flags[b];
        if (!(flags & EXISTS)) continue;
        Vec2 u = displacement_of(a, b);
        double extent[4] = {u.x, -u.x, u.y, -u.y};
        for (int k = 0; k < 4; k++) measured[k] = larger(measured[k], extent[k]);
        Neighbours to = neighbours_of(flags, lattice.nx, lattice.n);
        int there[4] = {to.east, to.north, to.north + to.east, to.north + to.west};
        for (int k = 0; k < 4; k++) {
            if (!(flags >> k & 1)) continue;
            Vec2 difference = displacement_of(a, b + there[k]) - u;
            measured[4] = larger(measured[4], fabs(difference.x));
            measured[5] = larger(measured[5], fabs(difference.y));
        }
    }
    int warp = threadIdx.x / WARP, lane = threadIdx.x % WARP;
    for (int k = 0; k < 6; k++) {
        double most = warp_max(measured[k]);
        if (lane == 0) shared.measured[k][warp] = most;
    }
}

// The first warp finds the largest of what warps have measured.
FN void join_measured(const Shared& shared, double* measured) {
    const double none = -of_bits(0x7ff0000000000000LL);
    int lane = threadIdx.x, warps = blockDim.x / WARP;
    for (int k = 0; k < 6; k++) measured[k] = warp_max(lane < warps ? shared.measured[k][lane] : k < 4 ? none : 0.0);
}

template <Springs SPRINGS, bool ENERGY> FN void sweep(const Lattice& lattice, const Blocks& a, Shared& shared) {
    Sums s = no_sums();
    const Step& step = shared.step;
    int nx = lattice.nx, n = lattice.n;
#pragma unroll 1
    for (int b = threadIdx.x; b < n; b += blockDim.x) {
        u32 flags = a.flags[b];
        if (!(flags & EXISTS)) continue;
        Neighbours to = neighbours_of(flags, nx, n);
        Around around;
        around.here = displacement_of(a, b);
        around.neighbours[EAST] = displacement_of(a, b + to.east);
        around.neighbours[WEST] = displacement_of(a, b + to.west);
        around.neighbours[NORTH] = displacement_of(a, b + to.north);
        around.neighbours[SOUTH] = displacement_of(a, b + to.south);
        around.neighbours[NORTH_EAST] = displacement_of(a, b + to.north + to.east);
        around.neighbours[NORTH_WEST] = displacement_of(a, b + to.north + to.west);
        around.neighbours[SOUTH_EAST] = displacement_of(a, b + to.south + to.east);
        around.neighbours[SOUTH_WEST] = displacement_of(a, b + to.south + to.west);
        Vec2 before = {a.vx[b], a.vy[b]};
        Moved moved = step_block<SPRINGS, ENERGY>(lattice.equations, step, around, flags, before, a.limit_squares[b],
                                                  a.impulses[b], s);
        a.vx[b] = moved.velocity.x;
        a.vy[b] = moved.velocity.y;
        if (moved.slips && a.first_slips[b] == 0xffffffffu) a.first_slips[b] = (u32)step.number;
    }
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

template <bool ENERGY> FN void sweep_with(Springs springs, const Lattice& lattice, const Blocks& a, Shared& shared) {
    if (springs == SHORT_SERIES) sweep<SHORT_SERIES, ENERGY>(lattice, a, shared);
    else if (springs == LONG_SERIES) sweep<LONG_SERIES, ENERGY>(lattice, a, shared);
    else sweep<SQUARE_ROOT, ENERGY>(lattice, a, shared);
}

FN Words words_over_warps(const i64* sums, int lane, int warps) {
    Words words = words_of(lane < warps ? sums[lane] : 0);
    words.low = warp_sum(words.low);
    words.high = warp_sum(words.high);
    return words;
}

// The first warp finds the sums over all blocks from those of the warps.
FN Totals join_sums(const Shared& shared) {
    int lane = threadIdx.x, warps = blockDim.x / WARP;
    Totals t;
    for (int axis = 0; axis < 2; axis++) {
        t.displacement[axis] = words_over_warps(shared.sums[axis], lane, warps);
        t.velocity[axis] = words_over_warps(shared.sums[2 + axis], lane, warps);
    }
    t.motion_square = words_over_warps(shared.sums[4], lane, warps);
    t.friction_work = words_over_warps(shared.sums[5], lane, warps);
    i64 counts = lane < warps ? shared.sums[6][lane] : 0;
    t.sliding = (u32)warp_sum(counts & 0xffff);
    t.slipping = (u32)warp_sum(counts >> 16);
    if (shared.step.has_energies) {
        t.velocity_squares = words_over_warps(shared.energies[0], lane, warps);
        t.displacement_square = words_over_warps(shared.energies[1], lane, warps);
        t.lattice_energy = words_over_warps(shared.energies[2], lane, warps);
    }
    t.stress_square = warp_max(lane < warps ? shared.stress_square[lane] : 0.0);
    t.speed_square = warp_max(lane < warps ? shared.speed_square[lane] : 0.0);
    if (shared.step.measures) join_measured(shared, t.measured);
    return t;
}

// Takes lattice number k through its steps. `memory` has room for BYTES_PER_BLOCK of each block.
FN void run_lattice(const Arrays& arrays, u32 k, double* memory, Shared& shared) {
    Lattice& lattice = arrays.lattices[k];
    u64 first_step = lattice.first_step, first_record = (u64)k * lattice.steps;
    int n = lattice.n;
    double* state = arrays.state + 4 * lattice.first_block;
    const double* given = arrays.given + 2 * (lattice.first_block + first_record);
    const double* positions = given + 2 * n;
    const u16* flags = arrays.flags + lattice.first_block;
    StepRecord* records = arrays.records + first_record;
    Blocks a = blocks_in(memory, n, arrays.first_slips + lattice.first_block);
    bool is_first_warp = threadIdx.x < WARP, is_first_thread = threadIdx.x == 0;
    for (int b = threadIdx.x; b < n; b += blockDim.x) {
        a.ux[b] = state[b];
        a.uy[b] = state[n + b];
        a.vx[b] = state[2 * n + b];
        a.vy[b] = state[3 * n + b];
        a.limit_squares[b] = given[b];
        a.impulses[b] = given[n + b];
        a.flags[b] = flags[b];
    }
    __syncthreads();
    bool measures = first_step % MEASUREMENT_INTERVAL == 0;
    if (measures) measure_blocks(lattice, a, shared);
    __syncthreads();
    if (is_first_warp) {
        double measured[6];
        if (measures) join_measured(shared, measured);
        if (is_first_thread) {
            if (measures) take_measured(lattice.motion.bounds, measured);
            begin_step(lattice, positions, lattice.motion.bounds, shared.step, first_step);
        }
    }
    // At the start displacements are those of t_0 already.
    move_blocks(a, n, first_step == 0 ? 0.0 : lattice.equations.dt);
    __syncthreads();
    for (u32 done = 0; done < lattice.steps; done++) {
        const Step& step = shared.step;
        if (step.has_energies) sweep_with<true>(step.springs, lattice, a, shared);
        else sweep_with<false>(step.springs, lattice, a, shared);
        if (step.measures) measure_blocks(lattice, a, shared);
        __syncthreads();
        bool is_last = done + 1 == lattice.steps;
        // The other warps need nothing of the next step to move their blocks.
        if (is_first_warp) {
            Totals totals = join_sums(shared);
            // No lane reads numbers of this step once those of the next one are written.
            __syncwarp();
            if (is_first_thread) {
                finish_step(lattice.equations, lattice.motion, step, totals, records[done]);
                if (!is_last) begin_step(lattice, positions, lattice.motion.bounds, shared.step, step.number + 1);
            }
        }
        if (!is_last) move_blocks(a, n, lattice.equations.dt);
        __syncthreads();
    }
    for (int b = threadIdx.x; b < n; b += blockDim.x) {
        state[b] = a.ux[b];
        state[n + b] = a.uy[b];
        state[2 * n + b] = a.vx[b];
        state[3 * n + b] = a.vy[b];
    }
}
