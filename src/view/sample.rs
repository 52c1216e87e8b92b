//! Hand-made answers for the tests of the reports.
