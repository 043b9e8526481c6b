// The kernels on emulated groups of threads, one lattice after the other.
#define EMULATED
#include "small_lattices.h"

extern "C" void slipfront_run_emulated(const Arrays* arrays, size_t count, int threads, int stride) {
    for (size_t k = 0; k < count; k++) {
        std::vector<double> memory((arrays->lattices[k].n * BYTES_PER_BLOCK + 7) / 8);
        auto shared = std::make_unique<Shared>();
        emulated::run(threads, stride, [&] { run_lattice(*arrays, k, memory.data(), *shared); });
    }
}
