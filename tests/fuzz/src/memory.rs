//! Measures the most memory that a piece of work has allocated at once.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

/// The system's allocator, which counts the bytes that are allocated at present, in all threads together:
/// pictures are drawn by several.
struct Counting;

static ALLOCATED: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
/// Held while a piece of work is measured: one at a time.
static MEASURING: Mutex<()> = Mutex::new(());

fn count_allocated(bytes: usize) {
    let allocated = ALLOCATED.fetch_add(bytes, Relaxed) + bytes;
    PEAK.fetch_max(allocated, Relaxed);
}

fn count_freed(bytes: usize) {
    ALLOCATED.fetch_sub(bytes, Relaxed);
}

#[allow(unsafe_code)] // A global allocator cannot be written otherwise; all work is the system's.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count_allocated(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        count_freed(layout.size());
        unsafe { System.dealloc(block, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count_allocated(layout.size());
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count_allocated(size);
        count_freed(layout.size());
        unsafe { System.realloc(block, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Runs `work`, and gives the most bytes that it had allocated at once.
pub(crate) fn peak_of(work: impl FnOnce()) -> usize {
    // A failed check poisons the lock, but the counts stay right.
    let _measuring = MEASURING.lock().unwrap_or_else(PoisonError::into_inner);
    let before = ALLOCATED.load(Relaxed);
    PEAK.store(before, Relaxed);
    work();
    PEAK.load(Relaxed).saturating_sub(before)
}
