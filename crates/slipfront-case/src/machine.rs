//! Memory and disk space that this machine has left.

use std::path::Path;

/// Memory that this process may still take, in bytes: what the machine can give without swapping, or what is left to its
/// control group if that is less. `None` if the system does not say.
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
    // What files of the group lie in memory for reading, such as those just written, is given back when asked for.
    let of_group = group.map(|limits| limits.total_memory.saturating_sub(limits.rss));
    let least = of_machine.into_iter().chain(of_group).min();
    least.map(|bytes| bytes as f64)
}

/// The largest part of `bytes` that the system allocates at once, to one part in ten thousand.
pub fn most_at_once(bytes: f64) -> f64 {
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

/// Whether the system allocates so many bytes at once; they are freed again without being used.
pub fn can_be_had(bytes: f64) -> bool {
    let mut all = Vec::<u8>::new();
    let reserved = all.try_reserve_exact(bytes as usize);
    // Memory that nobody looks at need not be asked for, as far as the compiler is concerned.
    std::hint::black_box(&mut all);
    reserved.is_ok()
}

/// Bytes that are free on the disk of a folder, which need not exist yet. `None` if the system does not say.
pub fn free_disk(folder: &Path) -> Option<f64> {
    let whole = std::path::absolute(folder).ok()?;
    let there = whole.ancestors().find(|path| path.is_dir())?;
    Some(fs4::available_space(there).ok()? as f64)
}
