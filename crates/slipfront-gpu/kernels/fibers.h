// Threads of a GPU as fibers of one thread of a CPU: each runs until it has to wait for others.
#pragma once
#include <setjmp.h>
#include <ucontext.h>

#include <functional>
#include <memory>
#include <vector>

namespace emulated {
struct Fiber {
    std::unique_ptr<char[]> stack;
    // Where it begins, and where it goes on.
    ucontext_t start;
    jmp_buf here;
    bool has_started = false;
};

// Threads first to first + count - 1, which wait for each other.
struct Meeting {
    int first, count, arrived = 0;
    long number = 0;
};

struct GroupOfThreads {
    std::vector<Fiber> fibers;
    std::vector<Meeting> warps;
    Meeting all;
    std::vector<long long> exchanged;
    std::function<void()> work;
    ucontext_t caller;
    int current = 0, stride = 1;
};
inline thread_local GroupOfThreads* group;

// Goes on with another thread, and comes back when another one goes on with this.
inline void switch_to(int next) {
    Fiber &from = group->fibers[group->current], &to = group->fibers[next];
    if (_setjmp(from.here)) return;
    group->current = next;
    if (to.has_started) _longjmp(to.here, 1);
    to.has_started = true;
    setcontext(&to.start);
}

// The last thread that arrives goes on; then the others find it in turn, each `stride` threads after another.
inline void meet(Meeting& meeting) {
    long number = meeting.number;
    if (++meeting.arrived == meeting.count) {
        meeting.arrived = 0;
        meeting.number++;
    }
    while (meeting.number == number) {
        switch_to(meeting.first + (group->current - meeting.first + group->stride) % meeting.count);
    }
}

inline void run_thread() {
    group->work();
    meet(group->all);
    setcontext(&group->caller);
}

// Runs `work` on each of `count` threads, a multiple of the lanes of a warp. Their order is set by the stride,
// which has no divisor in common with the count: a result that depends on it shows that a barrier is missing.
inline void run_group(int count, int stride, const std::function<void()>& work) {
    const size_t stack = 1 << 16;
    GroupOfThreads threads;
    threads.fibers = std::vector<Fiber>(count);
    threads.exchanged.assign(count, 0);
    threads.all = {0, count};
    threads.work = work;
    threads.stride = stride;
    for (int first = 0; first < count; first += LANES) threads.warps.push_back({first, LANES});
    for (Fiber& fiber : threads.fibers) {
        fiber.stack.reset(new char[stack]);
        getcontext(&fiber.start);
        fiber.start.uc_stack.ss_sp = fiber.stack.get();
        fiber.start.uc_stack.ss_size = stack;
        makecontext(&fiber.start, run_thread, 0);
    }
    group = &threads;
    threads.fibers[0].has_started = true;
    swapcontext(&threads.caller, &threads.fibers[0].start);
    group = nullptr;
}

// Runs `work` on the threads of each group, one group after the other, with the number of the group.
inline void run(int groups, int count, int stride, const std::function<void(int)>& work) {
    for (int k = 0; k < groups; k++) run_group(count, stride, [&] { work(k); });
}

inline int threads_of_group() { return group->all.count; }
inline int current_thread() { return group->current; }
inline void wait_for_group() { meet(group->all); }
inline void wait_for_warp() { meet(group->warps[group->current / LANES]); }
inline std::vector<long long>& exchanged() { return group->exchanged; }
}  // namespace emulated

// Threads take turns only where they wait for each other.
template <class T> void atomicAdd(T* sum, T term) { *sum += term; }
template <class T> void atomicMax(T* largest, T other) { *largest = *largest < other ? other : *largest; }
