//! Maps of coloured surfaces and what a camera should see of them.
