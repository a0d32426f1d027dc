//! Pictures of stored maps: works from the file alone.
