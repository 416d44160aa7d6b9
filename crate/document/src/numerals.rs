//! Durations and counts in words.

/// Returns a duration in words.
#[must_use]
pub fn duration(seconds: f64) -> String {
    if seconds < 0.95 {
        format!("{:.1} s", seconds.max(0.0))
    } else if seconds < 90.0 {
        format!("{seconds:.0} s")
    } else if seconds < 5400.0 {
        format!("{:.0} min", seconds / 60.0)
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}

/// Returns a count with a unit prefix: 1.2 M.
#[must_use]
pub fn count(number: u64) -> String {
    let number = number as f64;
    if number < 1e3 {
        format!("{number:.0}")
    } else if number < 1e6 {
        format!("{:.0} k", number / 1e3)
    } else if number < 1e9 {
        format!("{:.1} M", number / 1e6)
    } else {
        format!("{:.1} G", number / 1e9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_and_counts_are_short() {
        assert_eq!(duration(0.04), "0.0 s");
        assert_eq!(duration(12.4), "12 s");
        assert_eq!(duration(600.0), "10 min");
        assert_eq!(duration(7200.0), "2.0 h");
        assert_eq!(count(999), "999");
        assert_eq!(count(1_234_567), "1.2 M");
    }
}
