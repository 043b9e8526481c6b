// Many small lattices, each through many steps by a group of threads, with its blocks in their shared memory.
#pragma once
#include "group.h"

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

// A neighbour that lies beyond an edge is found at the other end of the lattice: there it is across a periodic edge,
// and else its spring is masked.
FN Neighbours neighbours_of(u32 flags, int nx, int n) {
    Neighbours to;
    to.east = flags & LAST_COLUMN ? 1 - nx : 1;
    to.west = flags & FIRST_COLUMN ? nx - 1 : -1;
    to.north = flags & LAST_ROW ? nx - n : nx;
    to.south = flags & FIRST_ROW ? n - nx : -nx;
    return to;
}

// Eq. 8.
FN void move_blocks(const Blocks& a, int n, double dt) {
    for (int b = threadIdx.x; b < n; b += blockDim.x) {
        a.ux[b] = a.ux[b] + dt * a.vx[b];
        a.uy[b] = a.uy[b] + dt * a.vy[b];
    }
}

// Impulses after the slip of the step that ends now. It is a loop by itself, so that other models need no registers for
// it.
FN void weaken_blocks(const Lattice& lattice, const Blocks& a, double* memory, u64 step) {
#pragma unroll 1
    for (int b = threadIdx.x; b < (int)lattice.n; b += blockDim.x) {
        Vec2 velocity = {a.vx[b], a.vy[b]};
        a.impulses[b] = impulse_after_slip(lattice.equations, step, velocity, memory, lattice.n, b);
    }
}

FN void count_blocks(const Arrays& arrays, const Lattice& lattice, const Blocks& a, u64 step) {
#pragma unroll 1
    for (int b = threadIdx.x; b < (int)lattice.n; b += blockDim.x) {
        Vec2 velocity = {a.vx[b], a.vy[b]};
        count_block(arrays, lattice, step, a.flags[b], velocity, b);
    }
}

FN void measure_blocks(const Lattice& lattice, const Blocks& a, Shared& shared) {
    Measured m = nothing_measured();
#pragma unroll 1
    for (int b = threadIdx.x; b < (int)lattice.n; b += blockDim.x) {
        u32 flags = a.flags[b];
        if (!(flags & EXISTS)) continue;
        measure_block(flags, around(a.ux, a.uy, b, neighbours_of(flags, lattice.nx, lattice.n)), m);
    }
    share_measured(m, shared);
}

template <Springs SPRINGS, bool ENERGY> FN void sweep(const Lattice& lattice, const Blocks& a, Shared& shared) {
    Sums sums = no_sums();
    const Step& step = shared.step;
    int nx = lattice.nx, n = lattice.n;
#pragma unroll 1
    for (int b = threadIdx.x; b < n; b += blockDim.x) {
        u32 flags = a.flags[b];
        if (!(flags & EXISTS)) continue;
        Vec2 before = {a.vx[b], a.vy[b]};
        Moved moved = step_block<SPRINGS, ENERGY>(lattice.equations, step, around(a.ux, a.uy, b, neighbours_of(flags, nx, n)),
                                                  flags, before, a.limit_squares[b], a.impulses[b], sums);
        a.vx[b] = moved.velocity.x;
        a.vy[b] = moved.velocity.y;
        if (moved.slips && a.first_slips[b] == NEVER) a.first_slips[b] = (u32)step.number;
    }
    share_sums<ENERGY>(sums, shared);
}

template <bool ENERGY> FN void sweep_with(Springs springs, const Lattice& lattice, const Blocks& a, Shared& shared) {
    if (springs == SHORT_SERIES) sweep<SHORT_SERIES, ENERGY>(lattice, a, shared);
    else if (springs == LONG_SERIES) sweep<LONG_SERIES, ENERGY>(lattice, a, shared);
    else sweep<SQUARE_ROOT, ENERGY>(lattice, a, shared);
}

// Takes lattice number k through its steps. `shared_blocks` has room for BYTES_PER_BLOCK of each block.
FN void run_lattice(const Arrays& arrays, u32 k, double* shared_blocks, Shared& shared) {
    Lattice& lattice = arrays.lattices[k];
    u64 first_step = lattice.first_step, first_record = (u64)k * lattice.steps;
    int n = lattice.n;
    double* state = arrays.state + 4 * lattice.first_block;
    const double* given = arrays.given + 2 * (lattice.first_block + first_record);
    const double* positions = given + 2 * n;
    const u16* flags = arrays.flags + lattice.first_block;
    StepRecord* records = arrays.records + first_record;
    Blocks a = blocks_in(shared_blocks, n, arrays.first_slips + lattice.first_block);
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
        Measured measured;
        if (measures) measured = join_measured(shared);
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
        if (falls(lattice.equations)) {
            double* memory = arrays.memory + lattice.first_memory;
            weaken_blocks(lattice, a, memory, step.number);
            if (step.has_energies) {
                add_weakening<true>(lattice, memory, threadIdx.x, blockDim.x);
                __syncthreads();
                add_weakening<false>(lattice, memory, threadIdx.x, blockDim.x);
            }
        }
        if (step.has_energies) sweep_with<true>(step.springs, lattice, a, shared);
        else sweep_with<false>(step.springs, lattice, a, shared);
        if (counts_at(lattice, step.number)) count_blocks(arrays, lattice, a, step.number);
        if (step.measures) measure_blocks(lattice, a, shared);
        __syncthreads();
        bool is_last = done + 1 == lattice.steps;
        // The other warps need nothing of the next step to move their blocks.
        if (is_first_warp) {
            Totals totals = join_sums(shared);
            // No lane reads numbers of this step once those of the next one are written.
            __syncwarp();
            if (is_first_thread) {
                finish_step(lattice, step, totals, records[done]);
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
