//! Work on several threads where the feature `rayon` is on, and on one otherwise, as where there are no threads.
//!
//! What fits one piece never leaves its thread: small work would cost more to hand over than to do.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// Runs `work` on every item, with its index.
pub(crate) fn for_each<T: Send>(items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
    #[cfg(feature = "rayon")]
    items.par_iter_mut().enumerate().for_each(|(i, item)| work(i, item));
    #[cfg(not(feature = "rayon"))]
    items.iter_mut().enumerate().for_each(|(i, item)| work(i, item));
}

/// Runs `work` on pieces of so many items, with the index of the first.
pub(crate) fn for_each_piece<T: Send>(items: &mut [T], size: usize, work: impl Fn(usize, &mut [T]) + Sync) {
    if items.len() <= size {
        return work(0, items);
    }
    #[cfg(feature = "rayon")]
    items.par_chunks_mut(size).enumerate().for_each(|(i, piece)| work(i * size, piece));
    #[cfg(not(feature = "rayon"))]
    items.chunks_mut(size).enumerate().for_each(|(i, piece)| work(i * size, piece));
}

/// How many pieces of work are worth their threads for so many items, of which each takes about a microsecond.
pub(crate) fn pieces(items: usize) -> usize {
    /// Fewer are not worth a thread.
    const FEW: usize = 64;
    #[cfg(feature = "rayon")]
    let threads = rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    let threads = 1;
    threads.min(items / FEW).max(1)
}

/// Runs `work` on as many pieces of the items as there are memories, a memory for each, with the index of the first item.
pub(crate) fn for_each_piece_with<T: Send, M: Send>(
    items: &mut [T],
    memories: &mut [M],
    work: impl Fn(usize, &mut [T], &mut M) + Sync,
) {
    let size = items.len().div_ceil(memories.len().max(1)).max(1);
    if items.len() <= size {
        if let Some(memory) = memories.first_mut() {
            work(0, items, memory);
        }
        return;
    }
    #[cfg(feature = "rayon")]
    items.par_chunks_mut(size).zip(memories).enumerate().for_each(|(i, (piece, memory))| work(i * size, piece, memory));
    #[cfg(not(feature = "rayon"))]
    items.chunks_mut(size).zip(memories).enumerate().for_each(|(i, (piece, memory))| work(i * size, piece, memory));
}

/// Whether `test` holds for all pieces of so many items; it is given the index of the first.
pub(crate) fn all_pieces<T: Sync>(items: &[T], size: usize, test: impl Fn(usize, &[T]) -> bool + Sync) -> bool {
    if items.len() <= size {
        return test(0, items);
    }
    #[cfg(feature = "rayon")]
    return items.par_chunks(size).enumerate().all(|(i, piece)| test(i * size, piece));
    #[cfg(not(feature = "rayon"))]
    return items.chunks(size).enumerate().all(|(i, piece)| test(i * size, piece));
}

/// The sum over pieces of so many items; `of` is given the index of the first.
pub(crate) fn sum_pieces<T: Sync>(items: &[T], size: usize, of: impl Fn(usize, &[T]) -> u32 + Sync) -> u32 {
    if items.len() <= size {
        return of(0, items);
    }
    #[cfg(feature = "rayon")]
    return items.par_chunks(size).enumerate().map(|(i, piece)| of(i * size, piece)).sum();
    #[cfg(not(feature = "rayon"))]
    return items.chunks(size).enumerate().map(|(i, piece)| of(i * size, piece)).sum();
}

/// What `work` makes of every item, in their order.
pub(crate) fn map<T: Send, R: Send>(items: Vec<T>, work: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(feature = "rayon")]
    return items.into_par_iter().map(work).collect();
    #[cfg(not(feature = "rayon"))]
    return items.into_iter().map(work).collect();
}

/// Sorts; what is equal is alike.
pub(crate) fn sort_unstable<T: Ord + Send>(items: &mut [T]) {
    #[cfg(feature = "rayon")]
    items.par_sort_unstable();
    #[cfg(not(feature = "rayon"))]
    items.sort_unstable();
}

/// Does both.
pub(crate) fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    #[cfg(feature = "rayon")]
    return rayon::join(a, b);
    #[cfg(not(feature = "rayon"))]
    return (a(), b());
}
