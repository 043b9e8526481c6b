// Kernels for a GPU.
#include "large_lattices.h"
#include "small_lattices.h"

// A group of threads takes one lattice, with its blocks in shared memory: 25 x 25 blocks leave room for six groups of
// 128 threads on a multiprocessor of 228 KiB, 64 x 64 for one of 512.
#define SMALL_LATTICES(NAME, THREADS, GROUPS)                                                          \
    extern "C" __global__ void __launch_bounds__(THREADS, GROUPS) NAME(Arrays arrays) {                \
        extern __shared__ double shared_blocks[];                                                      \
        __shared__ Shared shared;                                                                      \
        run_lattice(arrays, blockIdx.x, shared_blocks, shared);                                        \
    }

SMALL_LATTICES(small_lattices_128, 128, 6)
SMALL_LATTICES(small_lattices_256, 256, 2)
SMALL_LATTICES(small_lattices_512, 512, 1)

// Groups of threads along x of the grid are those of a lattice; lattices are along y.
extern "C" __global__ void __launch_bounds__(256, 2) measure_large(LargeLattices l) {
    __shared__ Tile tile;
    measure_tiles(l, blockIdx.y, blockIdx.x, tile);
}

extern "C" __global__ void __launch_bounds__(256, 2) step_large(LargeLattices l) {
    __shared__ Tile tile;
    step_lattice(l, blockIdx.y, blockIdx.x, tile);
}

extern "C" __global__ void __launch_bounds__(256, 2) largest_weakening_large(LargeLattices l) {
    add_weakening_of_group<true>(l, blockIdx.y, blockIdx.x);
}

extern "C" __global__ void __launch_bounds__(256, 2) add_weakening_large(LargeLattices l) {
    add_weakening_of_group<false>(l, blockIdx.y, blockIdx.x);
}

extern "C" __global__ void __launch_bounds__(256, 2) join_large(LargeLattices l) {
    __shared__ Totals of_warps[MAX_WARPS];
    join_lattice(l, blockIdx.y, of_warps);
}
