//! Sorting with little code, for lists that no ray waits for.

/// Sorts by heaps, in place; items of which neither is less than the other may change places. As
/// wasm each of the standard library's sorts takes up to 13 kB, and there is one for each kind of
/// item.
///
/// ```
/// let mut numbers = [3.0, -1.0, 2.0_f64];
/// field::heap_sort(&mut numbers, |a, b| a < b);
/// assert_eq!(numbers, [-1.0, 2.0, 3.0]);
/// ```
pub fn heap_sort<T>(items: &mut [T], mut less: impl FnMut(&T, &T) -> bool) {
    let count = items.len();
    // First each part becomes a heap, from the last; then the largest item goes behind what is left
    // of it.
    for step in (0..count + count / 2).rev() {
        let (mut root, end) = match step.checked_sub(count) {
            Some(root) => (root, count),
            None => {
                items.swap(0, step);
                (0, step)
            }
        };
        loop {
            let mut child = 2 * root + 1;
            if child >= end {
                break;
            }
            if child + 1 < end && less(&items[child], &items[child + 1]) {
                child += 1;
            }
            if !less(&items[root], &items[child]) {
                break;
            }
            items.swap(root, child);
            root = child;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_all_lengths_are_sorted() {
        let mut random = trials::Random::new(1);
        for length in 0..200 {
            // Few different values, and many.
            for range in [3, 5000] {
                let mut list: Vec<u32> = (0..length).map(|_| random.below(range) as u32).collect();
                let mut want = list.clone();
                want.sort_unstable();
                heap_sort(&mut list, |a, b| a < b);
                assert_eq!(list, want);
            }
        }
    }
}
