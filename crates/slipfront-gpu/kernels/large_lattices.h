// Lattices of any size, with their blocks in global memory. A step is two kernels: groups of threads take the tiles of
// each lattice; then one group for each lattice finishes the step and begins the next. Two more between them add up the
// weakening energy where it is needed. State is read from one array and written to another, since a tile also moves the
// blocks around it, which other tiles have.
#pragma once
#include "group.h"

// Blocks of a tile, which has another row or column of blocks on each side.
static const int TILE_X = 32, TILE_Y = 16, TILE_WIDTH = TILE_X + 2, CELLS = TILE_WIDTH * (TILE_Y + 2);

// Numbers of lattices that take a step, and of those of all groups of threads: groups of a lattice, one lattice after
// the other.
struct LargeLattices {
    Arrays arrays;
    // The state after the step; arrays.state has the one before.
    double* state_after;
    Step* steps;
    Totals* totals;
    // Groups of threads for each lattice, and number of steps that are done.
    u32 groups, done;
};

static_assert(sizeof(LargeLattices) == 104, "the size that src/large_lattices.rs has");

// What the threads of a group share.
struct Tile {
    Lattice lattice;
    int nx, ny;
    u32 columns, tiles;
    Shared shared;
    double ux[CELLS], uy[CELLS];
};

struct Corner {
    int x, y;
};

FN u32 tiles_of(u32 size, u32 tile) { return (size + tile - 1) / tile; }

FN void set_lattice(Tile& t, const Lattice& lattice) {
    t.lattice = lattice;
    t.nx = lattice.nx;
    t.ny = lattice.n / lattice.nx;
    t.columns = tiles_of(t.nx, TILE_X);
    t.tiles = t.columns * tiles_of(t.ny, TILE_Y);
}

FN Corner corner_of(const Tile& t, u32 tile) {
    Corner corner = {(int)(tile % t.columns) * TILE_X, (int)(tile / t.columns) * TILE_Y};
    return corner;
}

// Displacements of the blocks of a tile and around it after dt (Eq. 8). What lies beyond an edge is found at the other
// end of the lattice, as in small lattices.
FN void load_tile(Tile& t, const double* state, Corner corner, double dt) {
    const int nx = t.nx, ny = t.ny;
    const size_t n = t.lattice.n;
    for (int cell = threadIdx.x; cell < CELLS; cell += blockDim.x) {
        int x = corner.x + cell % TILE_WIDTH - 1, y = corner.y + cell / TILE_WIDTH - 1;
        if (x > nx || y > ny) continue;
        x = x < 0 ? nx - 1 : x == nx ? 0 : x;
        y = y < 0 ? ny - 1 : y == ny ? 0 : y;
        size_t b = (size_t)y * nx + x;
        t.ux[cell] = state[b] + dt * state[2 * n + b];
        t.uy[cell] = state[n + b] + dt * state[3 * n + b];
    }
}

// The block of a tile that a thread takes as number k, and its cell.
struct Place {
    bool is_inside;
    size_t block;
    int cell;
};

FN Place place_of(const Tile& t, Corner corner, int k) {
    int column = k % TILE_X, row = k / TILE_X, x = corner.x + column, y = corner.y + row;
    Place place;
    place.is_inside = x < t.nx && y < t.ny;
    place.block = (size_t)y * t.nx + x;
    place.cell = (row + 1) * TILE_WIDTH + column + 1;
    return place;
}

FN Around around_cell(const Tile& t, int cell) {
    Neighbours to = {1, -1, TILE_WIDTH, -TILE_WIDTH};
    return around(t.ux, t.uy, cell, to);
}

FN void measure_tile(const Tile& t, const u16* flags, Corner corner, Measured& m) {
#pragma unroll 1
    for (int k = threadIdx.x; k < TILE_X * TILE_Y; k += blockDim.x) {
        Place p = place_of(t, corner, k);
        if (p.is_inside && flags[p.block] & EXISTS) measure_block(flags[p.block], around_cell(t, p.cell), m);
    }
}

// Measures displacements before the first step, if that is a step at which they are measured.
FN void measure_tiles(const LargeLattices& l, u32 k, u32 group, Tile& t) {
    if (threadIdx.x == 0) set_lattice(t, l.arrays.lattices[k]);
    __syncthreads();
    if (t.lattice.first_step % MEASUREMENT_INTERVAL != 0) return;
    u64 first_block = t.lattice.first_block;
    Measured m = nothing_measured();
    for (u32 tile = group; tile < t.tiles; tile += l.groups) {
        Corner corner = corner_of(t, tile);
        load_tile(t, l.arrays.state + 4 * first_block, corner, 0.0);
        __syncthreads();
        measure_tile(t, l.arrays.flags + first_block, corner, m);
        __syncthreads();
    }
    share_measured(m, t.shared);
    __syncthreads();
    if (threadIdx.x < WARP) {
        m = join_measured(t.shared);
        if (threadIdx.x == 0) l.totals[(size_t)k * l.groups + group].measured = m;
    }
}

// Calls `work` with each block in the tiles of a group. Loops of their own need no registers in that of the steps.
template <class Work> FN void for_each_block(const LargeLattices& l, u32 group, const Tile& t, const Work& work) {
#pragma unroll 1
    for (u32 tile = group; tile < t.tiles; tile += l.groups) {
        Corner corner = corner_of(t, tile);
#pragma unroll 1
        for (int i = threadIdx.x; i < TILE_X * TILE_Y; i += blockDim.x) {
            Place p = place_of(t, corner, i);
            if (p.is_inside) work(p.block);
        }
    }
}

// Impulses after the slip of the step that ends now, of the blocks in the tiles of a group.
FN void weaken_tiles(const LargeLattices& l, u32 k, u32 group, const Tile& t) {
    const Lattice& lattice = t.lattice;
    const size_t n = lattice.n;
    const double* velocity = l.arrays.state + 4 * lattice.first_block + 2 * n;
    double* impulses = l.arrays.given + 2 * (lattice.first_block + (u64)k * lattice.steps) + n;
    double* memory = l.arrays.memory + lattice.first_memory;
    for_each_block(l, group, t, [&](size_t b) {
        Vec2 v = {velocity[b], velocity[n + b]};
        impulses[b] = impulse_after_slip(lattice.equations, t.shared.step.number, v, memory, n, b);
    });
}

// Counts the sliding blocks in the tiles of a group, whose velocities after the step are known.
FN void count_tiles(const LargeLattices& l, u32 group, const Tile& t) {
    const Lattice& lattice = t.lattice;
    const size_t n = lattice.n;
    const double* velocity = l.state_after + 4 * lattice.first_block + 2 * n;
    const u16* flags = l.arrays.flags + lattice.first_block;
    for_each_block(l, group, t, [&](size_t b) {
        Vec2 v = {velocity[b], velocity[n + b]};
        count_block(l.arrays, lattice, t.shared.step.number, flags[b], v, b);
    });
}

template <Springs SPRINGS, bool ENERGY> FN void step_tiles(const LargeLattices& l, u32 k, u32 group, Tile& t) {
    const Lattice& lattice = t.lattice;
    const Step& step = t.shared.step;
    const u64 first_block = lattice.first_block;
    const size_t n = lattice.n;
    const double* state = l.arrays.state + 4 * first_block;
    double* after = l.state_after + 4 * first_block;
    const double* given = l.arrays.given + 2 * (first_block + (u64)k * lattice.steps);
    const u16* flags = l.arrays.flags + first_block;
    u32* first_slips = l.arrays.first_slips + first_block;
    // At the start displacements are those of t_0 already.
    double dt = step.number == 0 ? 0.0 : lattice.equations.dt;
    Sums sums = no_sums();
    Measured m = nothing_measured();
#pragma unroll 1
    for (u32 tile = group; tile < t.tiles; tile += l.groups) {
        Corner corner = corner_of(t, tile);
        load_tile(t, state, corner, dt);
        __syncthreads();
#pragma unroll 1
        for (int i = threadIdx.x; i < TILE_X * TILE_Y; i += blockDim.x) {
            Place p = place_of(t, corner, i);
            if (!p.is_inside) continue;
            size_t b = p.block;
            Around around = around_cell(t, p.cell);
            Moved moved = {{state[2 * n + b], state[3 * n + b]}, false};
            if (flags[b] & EXISTS) {
                moved = step_block<SPRINGS, ENERGY>(lattice.equations, step, around, flags[b], moved.velocity, given[b],
                                                    given[n + b], sums);
            }
            after[b] = around.here.x;
            after[n + b] = around.here.y;
            after[2 * n + b] = moved.velocity.x;
            after[3 * n + b] = moved.velocity.y;
            if (moved.slips && first_slips[b] == NEVER) first_slips[b] = (u32)step.number;
        }
        if (step.measures) measure_tile(t, flags, corner, m);
        __syncthreads();
    }
    share_sums<ENERGY>(sums, t.shared);
    if (step.measures) share_measured(m, t.shared);
    __syncthreads();
    if (threadIdx.x < WARP) {
        Totals totals = join_sums(t.shared);
        if (threadIdx.x == 0) l.totals[(size_t)k * l.groups + group] = totals;
    }
}

template <bool ENERGY> FN void step_tiles_with(const LargeLattices& l, u32 k, u32 group, Tile& t) {
    Springs springs = t.shared.step.springs;
    if (springs == SHORT_SERIES) step_tiles<SHORT_SERIES, ENERGY>(l, k, group, t);
    else if (springs == LONG_SERIES) step_tiles<LONG_SERIES, ENERGY>(l, k, group, t);
    else step_tiles<SQUARE_ROOT, ENERGY>(l, k, group, t);
}

// Takes tiles number group, group + groups, ... of lattice number k through a step.
FN void step_lattice(const LargeLattices& l, u32 k, u32 group, Tile& t) {
    if (threadIdx.x == 0) {
        set_lattice(t, l.arrays.lattices[k]);
        t.shared.step = l.steps[k];
    }
    __syncthreads();
    if (falls(t.lattice.equations)) weaken_tiles(l, k, group, t);
    if (t.shared.step.has_energies) step_tiles_with<true>(l, k, group, t);
    else step_tiles_with<false>(l, k, group, t);
    if (counts_at(t.lattice, t.shared.step.number)) count_tiles(l, group, t);
}

// Adds the weakening energies of a part of the blocks of lattice number k, at a step at which they are needed.
template <bool LARGEST> FN void add_weakening_of_group(const LargeLattices& l, u32 k, u32 group) {
    Lattice& lattice = l.arrays.lattices[k];
    if (!falls(lattice.equations) || !l.steps[k].has_energies) return;
    const size_t threads = blockDim.x, first = group * threads + threadIdx.x;
    add_weakening<LARGEST>(lattice, l.arrays.memory + lattice.first_memory, first, l.groups * threads);
}

// Finishes the latest step of lattice number k and begins the next one; with none done, begins the first.
FN void join_lattice(const LargeLattices& l, u32 k, Totals (&of_warps)[MAX_WARPS]) {
    Totals totals = no_totals();
    for (u32 group = threadIdx.x; group < l.groups; group += blockDim.x) {
        add_totals(totals, l.totals[(size_t)k * l.groups + group]);
    }
    totals = totals_over_lanes(totals);
    if (threadIdx.x % WARP == 0) of_warps[threadIdx.x / WARP] = totals;
    __syncthreads();
    if (threadIdx.x != 0) return;
    for (int warp = 1; warp < (int)blockDim.x / WARP; warp++) add_totals(totals, of_warps[warp]);
    Lattice& lattice = l.arrays.lattices[k];
    const u32 done = l.done;
    const u64 first_record = (u64)k * lattice.steps, number = lattice.first_step + done;
    const double* positions = l.arrays.given + 2 * (lattice.first_block + first_record + lattice.n);
    Bounds& bounds = lattice.motion.bounds;
    if (done > 0) {
        StepRecord& record = l.arrays.records[first_record + done - 1];
        finish_step(lattice, l.steps[k], totals, record);
    } else if (number % MEASUREMENT_INTERVAL == 0) {
        take_measured(bounds, totals.measured);
    }
    if (done < lattice.steps) begin_step(lattice, positions, bounds, l.steps[k], number);
}
