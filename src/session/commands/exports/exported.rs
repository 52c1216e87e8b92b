//! What `export` writes, to which files.

use clap::ValueEnum;

/// What `export` writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Exported {
    /// Contact pairs
    Pairs,
    /// Pivots
    Pivots,
    /// Pivots with tied rows, and vertices with basics at zero
    Ties,
    /// Dictionary at the pivot shown
    Tableau,
    /// Displacements of the nodes
    Displacements,
    /// Member end forces
    Members,
    /// Reactions of supports and springs
    Reactions,
    /// Stresses at the nodes of plates, quads, triangles and solids
    Stresses,
    /// Resultants of the edge contacts
    Resultants,
    /// Quantities that are named
    #[value(alias = "show")]
    Quantities,
    /// Probes of the scenario
    Probes,
    /// Parameters with their values and ranges
    #[value(alias = "params")]
    Parameters,
    /// What differs from the file
    Diff,
    /// Numbers of the check; `check exact`: what it proves
    Check,
    /// Load combinations
    #[value(alias = "combine")]
    Combinations,
    /// Least and largest value over the combinations
    Envelope,
    /// Every answer that `enumerate` finds
    #[value(alias = "enumerate")]
    Answers,
    /// The direction of the ray, and what it means
    Ray,
    /// What would stop the collapse of a ray
    Remedies,
    /// Every covering, tie-break and engine
    Compare,
    /// What one more unit of a parameter does to the pairs
    Sensitivity,
    /// The friction above which more than one answer is possible
    Critical,
    /// Where a quantity is as wanted
    Find,
    /// The limit of a load
    Limit,
    /// Stages of the history that `stages` followed
    Stages,
    /// What a load repeated does, cycle by cycle
    Cycle,
    /// What was measured, beside what the friction found for it gives
    Calibrate,
    /// What the last `trace` or `stages` followed
    #[value(alias = "trace")]
    Path,
    /// The last `sweep` that was shown
    Sweep,
    /// The last `sample`: probabilities, quantiles and histograms
    Sample,
    /// The last `map`: its regions, or a picture
    Map,
    /// What `summary` shows
    Summary,
    /// The embedded scenarios
    Scenarios,
    /// The whole result as `solve --format json` prints it
    Result,
    /// The scenario, its answer, tables and figures: one file of HTML, or Markdown
    Report,
    /// The structure with its results, for ParaView
    Vtu,
    /// Picture: the structure with the states of its pairs, deformed
    Structure,
    /// Picture: the collapse mode of a ray
    Mode,
    /// Picture: slip along the contact zone
    Slip,
    /// Picture: friction force within its bound
    Force,
    /// Picture: distance open
    Gap,
    /// Picture: compressive force
    Pressure,
    /// Picture: forces of edges per length, of faces per area
    Traction,
    /// Picture: p over the pivots
    P,
    /// Picture: bending moments, in space M_z
    Moment,
    /// Picture: shear forces, in space V_y
    Shear,
    /// Picture: normal forces
    Axial,
    /// Picture: shear forces V_z of bars in space
    #[value(name = "Vz")]
    ShearZ,
    /// Picture: torques of bars in space
    #[value(name = "T")]
    Torsion,
    /// Picture: bending moments M_y of bars in space
    #[value(name = "My")]
    MomentY,
    /// The LCP for other solvers: a scenario of its own (.json) or Matrix Market (.mtx)
    Lcp,
    /// What proofs are about: the contact system or the bare LCP at the present values, a scenario of its own
    System,
    /// K and F for other programs, with the scenario that reads them back as a superelement (.json or .mtx)
    Stiffness,
}

impl Exported {
    /// Endings of the files it can be written to.
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Exported::Result | Exported::Summary | Exported::System => &["json"],
            Exported::Vtu => &["vtu", "pvd"],
            Exported::Report => &["html", "md"],
            Exported::Lcp | Exported::Stiffness => &["json", "mtx"],
            Exported::Path | Exported::Map => &["csv", "json", "svg"],
            Exported::Structure
            | Exported::Mode
            | Exported::Slip
            | Exported::Force
            | Exported::Gap
            | Exported::Pressure
            | Exported::Traction => &["svg"],
            Exported::P | Exported::Moment | Exported::Shear | Exported::Axial => &["svg"],
            Exported::ShearZ | Exported::Torsion | Exported::MomentY => &["svg"],
            _ => &["csv", "json"],
        }
    }

    /// How many words may stand between it and the file.
    pub fn most_words(self) -> usize {
        match self {
            Exported::Quantities | Exported::Envelope | Exported::Find => usize::MAX,
            Exported::Cycle | Exported::Calibrate | Exported::Path => usize::MAX,
            Exported::Slip | Exported::Force | Exported::Gap | Exported::Pressure | Exported::Traction => usize::MAX,
            Exported::Sensitivity | Exported::Critical | Exported::Limit | Exported::Check | Exported::Report => 1,
            Exported::Moment | Exported::Shear | Exported::Axial => 1,
            Exported::ShearZ | Exported::Torsion | Exported::MomentY => 1,
            _ => 0,
        }
    }
}
