//! The pipeline: scenario → prepared geometry (once) → solved state (for every change of a parameter).
