mod fold; pub use fold::*;
