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

/// A number that stands for the name of this machine.
pub fn machine_number() -> i64 {
    // Machines without a name are taken for one: what is found on them is compared otherwise.
    let name = sysinfo::System::host_name().unwrap_or_default();
    let hash = blake3::hash(name.as_bytes());
    i64::from_le_bytes(hash.as_bytes().as_chunks().0[0])
}

/// Time that a processor has spent on this thread, so that other work on the machine does not count.
#[cfg(all(unix, feature = "disk"))]
pub fn thread_time() -> Duration {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}

/// Time since the first call, where the system gives none of a thread: other work on the machine counts.
#[cfg(not(all(unix, feature = "disk")))]
pub fn thread_time() -> Duration {
    use std::sync::LazyLock;
    use std::time::Instant;
    static BEGAN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGAN.elapsed()
}

/// Memory that this process may still take, in bytes: the memory that the machine can give without swapping,
/// or the rest of its control group or of its limit of addresses (`ulimit -v`) if that is less. `None` if the
/// system does not say.
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
    // What files of the group lie in memory for reading, such as those just written, is given back when asked
    // for.
    let of_group = group.map(|limits| limits.total_memory.saturating_sub(limits.rss));
    let least = of_machine
        .into_iter()
        .chain(of_group)
        .chain(addresses_left())
        .min();
    least.map(|bytes| bytes as f64)
}

/// Bytes of addresses that a thread may take beside the memory that is asked for: its stack, and an arena,
/// for which the allocator of glibc wants twice as much for a moment. A thread that gets no arena takes a
/// page for every small piece.
const THREAD_ADDRESSES: u64 = (2 + 128) << 20;

/// Least number of bytes of addresses that are left to the work of the threads.
const ADDRESSES_TO_WORK: u64 = 64 << 20;

/// Bytes of addresses that this process may still take; none without a limit, or if the system does not say.
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

/// Number of the `wanted` threads that have room within the limit of addresses of this process (`ulimit -v`),
/// each with `others` that it needs.
pub fn threads_that_fit(wanted: usize, others: usize) -> usize {
    let Some(left) = addresses_left() else {
        return wanted;
    };
    let each = (1 + others as u64) * THREAD_ADDRESSES;
    wanted.min((left.saturating_sub(ADDRESSES_TO_WORK) / each) as usize)
}

/// Memory out of `bytes` that this process can get, in bytes: the whole, or the rest.
pub fn available_of(bytes: f64) -> f64 {
    most_at_once(bytes.min(available_memory().unwrap_or(f64::INFINITY)))
}

/// The largest part of `bytes` that the system allocates at once, to one part in ten thousand.
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

/// Whether the system allocates `bytes` at once; they are freed again without being used.
pub fn can_be_had(bytes: f64) -> bool {
    let mut all = Vec::<u8>::new();
    let reserved = all.try_reserve_exact(bytes as usize);
    // Memory that nobody looks at need not be asked for, as far as the compiler is concerned.
    std::hint::black_box(&mut all);
    reserved.is_ok()
}
