//! How much memory a model will need, estimated before anything is generated, and how much there is.

/// Bytes per node: mesh, assembled matrix and its sparse factor. Measured: 467 MB for 160 400 nodes.
const BYTES_PER_NODE: f64 = 3000.0;

/// Bytes per byte of a scenario file: its text, the tree of its values, and what is read from them. Measured, the check
/// of the whole file: 12.4 where it is 800 000 bare nodes, 13.4 of single quads, 14.6 and 17.8 where an LCP and a contact
/// stiffness of 2600 rows are zeros of one digit; 3.3 where the entries have all their digits. A third is added.
const BYTES_PER_BYTE: f64 = 24.0;

/// Bytes per byte of a mesh file. Measured: 226 MB for the 15 MB of 251 000 nodes.
const BYTES_PER_MESH_BYTE: f64 = 15.0;

/// What threads and their pools take of a limited address space, for models that need more than [`SMALL`].
const THREADS: f64 = 192.0 * MIB;
const SMALL: f64 = 16.0 * MIB;

/// Assumed where the size of the memory cannot be read.
const ASSUMED_MEMORY: f64 = 64.0 * GIB;

const MIB: f64 = 1024.0 * 1024.0;
const GIB: f64 = 1024.0 * MIB;

/// Bytes needed for a model with this many nodes.
pub fn for_nodes(nodes: f64) -> f64 {
    BYTES_PER_NODE * nodes
}

/// Bytes needed to read a scenario of this many bytes.
pub fn for_text(bytes: usize) -> f64 {
    BYTES_PER_BYTE * bytes as f64
}

/// Bytes needed to read a mesh file of this many bytes: the file and what is read from it, before it becomes a model.
pub fn for_mesh(bytes: usize) -> f64 {
    BYTES_PER_MESH_BYTE * bytes as f64
}

/// Bytes needed for this many contact joints: R, its copy without the kernel, and the dictionary of the pivots with the
/// steps that wait, all dense.
pub fn for_joints(joints: f64) -> f64 {
    6.0 * 8.0 * joints * joints
}

/// Bytes needed for this many entries of a sparse matrix: read, checked and assembled.
pub fn for_entries(entries: f64) -> f64 {
    120.0 * entries
}

/// `needs about 2.8 TiB of memory, this machine has 15.6 GiB`, if that is too much for this machine, or for what this
/// process may use of it.
pub fn refusal(bytes: f64) -> Option<String> {
    let needs = format!("needs about {} of memory", readable(bytes));
    if let Some(left) = address_space_left()
        && bytes > SMALL
        && bytes + THREADS > left
    {
        return Some(format!(
            "{needs}, this process may use {} more (`ulimit -v`)",
            readable((left - THREADS).max(0.0))
        ));
    }
    let memory = physical_memory();
    // A fraction stays for everything else.
    if bytes <= 0.9 * memory.unwrap_or(ASSUMED_MEMORY) {
        return None;
    }
    Some(match memory {
        Some(memory) => format!("{needs}, this machine has {}", readable(memory)),
        None => format!("{needs}, more than the {} allowed", readable(ASSUMED_MEMORY)),
    })
}

/// Bytes of address space that are left, where they are limited.
pub fn address_space_left() -> Option<f64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    left(&limits, &status)
}

fn left(limits: &str, status: &str) -> Option<f64> {
    let limit = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: f64 = limit.split_whitespace().next()?.parse().ok()?; // or `unlimited`
    Some((limit - in_bytes(status, "VmSize:")?).max(0.0))
}

/// Bytes this process can use: what the system calls available, or its control group's limit, or the address space that
/// is left, if that is less. `None` where the system does not tell (other than Linux).
pub fn available_memory() -> Option<u64> {
    let system = meminfo("MemAvailable:")? as u64;
    let limit =
        std::fs::read_to_string("/sys/fs/cgroup/memory.max").ok().and_then(|text| text.trim().parse::<u64>().ok());
    let space = address_space_left().map(|bytes| bytes as u64);
    Some([limit, space].into_iter().flatten().fold(system, u64::min))
}

/// Bytes of physical memory, where the system tells.
fn physical_memory() -> Option<f64> {
    meminfo("MemTotal:")
}

/// Bytes that a line of `/proc/meminfo` names.
fn meminfo(line: &str) -> Option<f64> {
    in_bytes(&std::fs::read_to_string("/proc/meminfo").ok()?, line)
}

fn in_bytes(text: &str, line: &str) -> Option<f64> {
    let amount = text.lines().find_map(|text| text.strip_prefix(line))?;
    let kibibytes: f64 = amount.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024.0)
}

pub fn readable(bytes: f64) -> String {
    let units = [("MiB", 1.0 / 1024.0), ("GiB", 1.0), ("TiB", 1024.0), ("PiB", 1024.0 * 1024.0)];
    let amount = bytes / GIB;
    // The largest unit that gives at least 1; MiB for anything smaller.
    let (unit, size) = units.into_iter().rev().find(|(_, size)| amount >= *size).unwrap_or(units[0]);
    let amount = amount / size;
    if amount < 1e4 { format!("{amount:.1} {unit}") } else { format!("{amount:.1e} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_readable() {
        assert_eq!(readable(1.5 * GIB), "1.5 GiB");
        assert_eq!(readable(2048.0 * GIB), "2.0 TiB");
        assert_eq!(readable(0.5 * GIB), "512.0 MiB");
        assert_eq!(readable(0.0), "0.0 MiB");
        assert_eq!(readable(1e12 * GIB), "9.5e5 PiB");
    }

    #[test]
    fn the_limit_of_the_address_space_is_read() {
        let limits = |limit: &str| format!("Limit   Soft Limit\nMax address space  {limit}   unlimited   bytes\n");
        let status = "Name: x\nVmSize:\t    2000 kB\n";
        assert_eq!(left(&limits("unlimited"), status), None);
        assert_eq!(left(&limits("4096000"), status), Some(2048000.0));
        assert_eq!(left(&limits("1000"), status), Some(0.0));
    }

    #[test]
    fn the_line_of_meminfo_is_read() {
        let text = "MemTotal:       24 kB\nMemFree: 3 kB\nMemAvailable:   22 kB\n";
        assert_eq!(in_bytes(text, "MemAvailable:"), Some(22.0 * 1024.0));
        assert_eq!(in_bytes("MemTotal: 24 kB\n", "MemAvailable:"), None);
    }

    #[test]
    fn only_what_does_not_fit_is_refused() {
        assert_eq!(refusal(for_nodes(1000.0)), None);
        // Two unknowns to a node of a plate: 1e6 unknowns are welcome on 4 GiB, 1e8 on no desk.
        assert!(for_nodes(5e5) < 4.0 * GIB && for_nodes(5e7) > 100.0 * GIB);
        assert!(refusal(for_nodes(1e12)).unwrap().starts_with("needs about 2.7 PiB"));
    }
}
