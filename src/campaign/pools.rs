//! Threads for runs that go on side by side.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// `jobs` pools that share `threads` threads; each has at least one.
pub(super) fn pools(threads: usize, jobs: usize) -> Result<Vec<ThreadPool>, ThreadPoolBuildError> {
    let pool = |job: usize| {
        // What does not divide evenly goes to the first pools.
        let share = threads / jobs + usize::from(job < threads % jobs);
        ThreadPoolBuilder::new().num_threads(share.max(1)).build()
    };
    (0..jobs).map(pool).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_thread_is_in_one_pool() {
        let shares = |threads, jobs| -> Vec<usize> {
            pools(threads, jobs).unwrap().iter().map(ThreadPool::current_num_threads).collect()
        };
        assert_eq!((shares(5, 3), shares(1, 2), shares(4, 0)), (vec![2, 2, 1], vec![1, 1], vec![]));
    }
}
