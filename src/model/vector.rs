//! Vectors and places in space; in the plane their last entry is 0, which changes no digit of what is computed here.

/// a · b.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The way from `a` to `b`.
pub fn way(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| b[c] - a[c])
}

/// Its length, with neither overflow nor underflow on the way.
pub fn length([x, y, z]: [f64; 3]) -> f64 {
    x.hypot(y).hypot(z)
}

/// The distance of two places.
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    length(way(a, b))
}

/// The unit vector along `a`; `None` for the zero vector.
pub fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = length(a);
    (length > 0.0).then(|| a.map(|a| a / length))
}

/// (x, y) as a vector.
pub fn flat([x, y]: [f64; 2]) -> [f64; 3] {
    [x, y, 0.0]
}
