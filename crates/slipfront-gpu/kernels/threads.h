// Threads of a GPU as threads of a CPU, for sanitizers: they find memory that threads use without a barrier between
// them, and uses of memory beyond the end of an array. An exchange between lanes is a barrier of their warp here, which
// it is not on a GPU.
#pragma once
#include <atomic>
#include <barrier>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace emulated {
struct GroupOfThreads {
    int count;
    std::barrier<> all{count};
    std::vector<std::unique_ptr<std::barrier<>>> warps;
    std::vector<long long> exchanged;
};
inline thread_local GroupOfThreads* group;
inline thread_local int current;

// Runs `work` on the threads of each group, all groups at once, with the number of the group.
inline void run(int groups, int count, int, const std::function<void(int)>& work) {
    std::vector<std::unique_ptr<GroupOfThreads>> all;
    std::vector<std::jthread> threads;
    for (int k = 0; k < groups; k++) {
        all.emplace_back(new GroupOfThreads{.count = count, .warps = {}, .exchanged = std::vector<long long>(count)});
        for (int first = 0; first < count; first += LANES) {
            all[k]->warps.push_back(std::make_unique<std::barrier<>>(LANES));
        }
        for (int thread = 0; thread < count; thread++) {
            threads.emplace_back([=, here = all[k].get(), &work] {
                group = here;
                current = thread;
                work(k);
            });
        }
    }
    threads.clear();
}

inline int threads_of_group() { return group->count; }
inline int current_thread() { return current; }
inline void wait_for_group() { group->all.arrive_and_wait(); }
inline void wait_for_warp() { group->warps[current / LANES]->arrive_and_wait(); }
inline std::vector<long long>& exchanged() { return group->exchanged; }
}  // namespace emulated

template <class T> void atomicAdd(T* sum, T term) { std::atomic_ref<T>(*sum).fetch_add(term); }
template <class T> void atomicMax(T* largest, T other) {
    std::atomic_ref<T> found(*largest);
    for (T value = found; value < other && !found.compare_exchange_weak(value, other);) {
    }
}
