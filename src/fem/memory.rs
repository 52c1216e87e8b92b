//! How much memory there is, so that a model that cannot fit is refused before the work.

use std::fs::read_to_string;

use crate::model::memory::address_space_left;

/// Bytes this process can use: what the system calls available, or its control group's limit, or the address space that
/// is left, if that is less. `None` where the system does not tell (other than Linux).
pub fn available_memory() -> Option<u64> {
    let system = meminfo_available(&read_to_string("/proc/meminfo").ok()?)?;
    let limit = read_to_string("/sys/fs/cgroup/memory.max").ok().and_then(|text| text.trim().parse::<u64>().ok());
    let space = address_space_left().map(|bytes| bytes as u64);
    Some([limit, space].into_iter().flatten().fold(system, u64::min))
}

fn meminfo_available(text: &str) -> Option<u64> {
    let line = text.lines().find(|line| line.starts_with("MemAvailable:"))?;
    let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_the_line_of_meminfo() {
        let text = "MemTotal:       24 kB\nMemFree: 3 kB\nMemAvailable:   22 kB\n";
        assert_eq!(meminfo_available(text), Some(22 * 1024));
        assert_eq!(meminfo_available("MemTotal: 24 kB\n"), None);
    }
}
