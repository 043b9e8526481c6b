// The kernels on emulated groups of threads, one group after the other.
#define EMULATED
#include "large_lattices.h"
#include "small_lattices.h"

extern "C" void slipfront_run_small(const Arrays* arrays, size_t count, int threads, int stride) {
    for (size_t k = 0; k < count; k++) {
        std::vector<double> memory((arrays->lattices[k].n * BYTES_PER_BLOCK + 7) / 8);
        auto shared = std::make_unique<Shared>();
        emulated::run(threads, stride, [&] { run_lattice(*arrays, k, memory.data(), *shared); });
    }
}

extern "C" void slipfront_run_large(const Arrays* arrays, size_t count, u32 groups, int threads, int stride) {
    const Lattice* lattices = arrays->lattices;
    const size_t n = lattices[count - 1].first_block + lattices[count - 1].n;
    std::vector<Step> steps(count);
    std::vector<Totals> totals(count * groups, no_totals());
    std::vector<double> other(4 * n);
    LargeLattices l = {*arrays, other.data(), steps.data(), totals.data(), groups, 0};
    auto tile = std::make_unique<Tile>();
    Totals of_warps[MAX_WARPS];
    auto for_all_groups = [&](auto work) {
        for (size_t k = 0; k < count; k++) {
            for (u32 group = 0; group < groups; group++) emulated::run(threads, stride, [&] { work(k, group); });
        }
    };
    auto join = [&] {
        for (size_t k = 0; k < count; k++) emulated::run(threads, stride, [&] { join_lattice(l, k, of_warps); });
    };
    for_all_groups([&](u32 k, u32 group) { measure_tiles(l, k, group, *tile); });
    join();
    while (l.done < lattices->steps) {
        for_all_groups([&](u32 k, u32 group) { step_lattice(l, k, group, *tile); });
        for_all_groups([&](u32 k, u32 group) { add_weakening_of_group<true>(l, k, group); });
        for_all_groups([&](u32 k, u32 group) { add_weakening_of_group<false>(l, k, group); });
        l.done++;
        join();
        std::swap(l.arrays.state, l.state_after);
    }
    if (l.arrays.state != arrays->state) std::copy(other.begin(), other.end(), arrays->state);
}
