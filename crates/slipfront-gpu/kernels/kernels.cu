// Kernels for a GPU. A group of threads takes one lattice, with its blocks in shared memory: 25 x 25 blocks
// leave room for six groups of 128 threads on a multiprocessor of 228 KiB, 64 x 64 for one of 512.
#include "small_lattices.h"

#define SMALL_LATTICES(NAME, THREADS, GROUPS)                                                    \
    extern "C" __global__ void __launch_bounds__(THREADS, GROUPS) NAME(Lattice* lattices) {      \
        extern __shared__ double memory[];                                                       \
        __shared__ Shared shared;                                                                \
        run_lattice(lattices[blockIdx.x], memory, shared);                                       \
    }

SMALL_LATTICES(small_lattices_128, 128, 6)
SMALL_LATTICES(small_lattices_256, 256, 2)
SMALL_LATTICES(small_lattices_512, 512, 1)
