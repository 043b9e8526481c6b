// The kernels on emulated groups of threads.
#define EMULATED
#include "large_lattices.h"
#include "small_lattices.h"

extern "C" void slipfront_run_small(const Arrays* arrays, size_t count, int threads, int stride) {
    std::vector<std::vector<double>> memory;
    for (size_t k = 0; k < count; k++) memory.emplace_back((arrays->lattices[k].n * BYTES_PER_BLOCK + 7) / 8);
    std::vector<Shared> shared(count);
    emulated::run(count, threads, stride, [&](int k) { run_lattice(*arrays, k, memory[k].data(), shared[k]); });
}

extern "C" void slipfront_run_large(const Arrays* arrays, size_t count, u32 groups, int threads, int stride) {
    const Lattice* lattices = arrays->lattices;
    const size_t n = lattices[count - 1].first_block + lattices[count - 1].n;
    std::vector<Step> steps(count);
    std::vector<Totals> totals(count * groups, no_totals());
    std::vector<double> other(4 * n);
    LargeLattices l = {*arrays, other.data(), steps.data(), totals.data(), groups, 0};
    std::vector<Tile> tiles(count * groups);
    struct OfWarps {
        Totals totals[MAX_WARPS];
    };
    std::vector<OfWarps> of_warps(count);
    auto for_all_groups = [&](auto work) {
        emulated::run(count * groups, threads, stride, [&](int g) { work(g / groups, g % groups, tiles[g]); });
    };
    auto join = [&] {
        emulated::run(count, threads, stride, [&](int k) { join_lattice(l, k, of_warps[k].totals); });
    };
    for_all_groups([&](u32 k, u32 group, Tile& tile) { measure_tiles(l, k, group, tile); });
    join();
    while (l.done < lattices->steps) {
        for_all_groups([&](u32 k, u32 group, Tile& tile) { step_lattice(l, k, group, tile); });
        for_all_groups([&](u32 k, u32 group, Tile&) { add_weakening_of_group<true>(l, k, group); });
        for_all_groups([&](u32 k, u32 group, Tile&) { add_weakening_of_group<false>(l, k, group); });
        l.done++;
        join();
        std::swap(l.arrays.state, l.state_after);
    }
    if (l.arrays.state != arrays->state) std::copy(other.begin(), other.end(), arrays->state);
}
