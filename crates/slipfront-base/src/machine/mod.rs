//! Free memory and disk space of this machine, and its identity.

use std::time::Duration;

#[cfg(feature = "disk")]
mod of_system;
#[cfg(not(feature = "disk"))]
mod without_disk;

#[cfg(feature = "disk")]
pub use self::of_system::{free_disk, host_name};
#[cfg(not(feature = "disk"))]
pub use self::without_disk::{free_disk, host_name};

/// Hash of the name of this machine, as a number.
pub fn machine_number() -> i64 {
    // Machines without a name count as one machine: callers also compare what they find on each machine.
    let name = sysinfo::System::host_name().unwrap_or_default();
    let hash = blake3::hash(name.as_bytes());
    i64::from_le_bytes(hash.as_bytes().as_chunks().0[0])
}

/// Processor time of this thread, which excludes other work on the machine.
#[cfg(all(unix, feature = "disk"))]
pub fn thread_time() -> Duration {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}

/// Time since the first call, for systems without a clock per thread: other work on the machine counts.
#[cfg(not(all(unix, feature = "disk")))]
pub fn thread_time() -> Duration {
    use std::sync::LazyLock;
    use std::time::Instant;
    static BEGAN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGAN.elapsed()
}

/// Memory that this process may still take, in bytes: the memory that the machine can give without swapping,
/// or the rest of its control group or of its address-space limit (`ulimit -v`) if that is less. `None` if
/// the system does not report it.
pub fn available_memory() -> Option<f64> {
    use sysinfo::{ProcessRefreshKind, ProcessesToUpdate, System};
    let mut system = System::new().ok()?;
    system.refresh_memory();
    let of_machine = Some(system.available_memory()).filter(|&bytes| bytes > 0);
    let group = sysinfo::get_current_pid().ok().and_then(|own| {
        system.refresh_processes_specifics(
            ProcessesToUpdate::Some(&[own]),
            false,
            ProcessRefreshKind::nothing(),
        );
        system.process(own)?.cgroup_limits()
    });
    // The system gives back the page cache of the group, such as files just written, on demand.
    let of_group = group.map(|limits| limits.total_memory.saturating_sub(limits.rss));
    let least = of_machine
        .into_iter()
        .chain(of_group)
        .chain(addresses_left())
        .min();
    least.map(|bytes| bytes as f64)
}

/// Address space in bytes that a thread may take in addition to the memory that it requests: its stack, and
/// an arena, for which the allocator of glibc briefly reserves twice the size. A thread that gets no arena
/// takes a page for every small allocation.
const THREAD_ADDRESSES: u64 = (2 + 128) << 20;

/// Least address space in bytes that is left for the work of the threads.
const ADDRESSES_TO_WORK: u64 = 64 << 20;

/// Address space in bytes that this process may still take; none without a limit, or if the system does not
/// report it.
fn addresses_left() -> Option<u64> {
    let read = |name, key: &str| {
        let text = std::fs::read_to_string(name).ok()?;
        let rest = text.lines().find_map(|line| line.strip_prefix(key))?;
        rest.split_whitespace().next()?.parse::<u64>().ok()
    };
    let limit = read("/proc/self/limits", "Max address space")?;
    let taken = 1024 * read("/proc/self/status", "VmSize:")?;
    Some(limit.saturating_sub(taken))
}

/// Number of the `wanted` threads that fit within the address-space limit of this process (`ulimit -v`), each
/// with the `others` that it needs.
pub fn threads_that_fit(wanted: usize, others: usize) -> usize {
    let Some(left) = addresses_left() else {
        return wanted;
    };
    let each = (1 + others as u64) * THREAD_ADDRESSES;
    wanted.min((left.saturating_sub(ADDRESSES_TO_WORK) / each) as usize)
}

/// Part of `bytes` that this process can allocate, in bytes.
pub fn available_of(bytes: f64) -> f64 {
    most_at_once(bytes.min(available_memory().unwrap_or(f64::INFINITY)))
}

/// Largest part of `bytes` that the system allocates in one piece, to one part in ten thousand.
fn most_at_once(bytes: f64) -> f64 {
    if can_be_had(bytes) {
        return bytes;
    }
    let (mut given, mut refused) = (0.0, bytes);
    while refused - given > 1e-4 * bytes {
        let between = 0.5 * (given + refused);
        if can_be_had(between) {
            given = between;
        } else {
            refused = between;
        }
    }
    given
}

/// Whether the system allocates `bytes` in one piece; they are freed again without being used.
pub fn can_be_had(bytes: f64) -> bool {
    let mut all = Vec::<u8>::new();
    let reserved = all.try_reserve_exact(bytes as usize);
    // Otherwise the compiler may remove the allocation, because nothing uses the memory.
    std::hint::black_box(&mut all);
    reserved.is_ok()
}
