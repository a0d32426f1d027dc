//! Macros that make a vector unit from its token, its registers and the names of its instructions.
//!
//! Why the instructions are safe: the vector types of a unit are private to the unit's file. So only generic code makes vectors, and only
//! where [`SimdTask::run`](super::SimdTask::run) is called with such a type. That call is in a function that enables the unit's features,
//! and only the unit's token calls it. Only `detect` makes a token, after it has tested the processor. Vectors cannot outlive the call:
//! neither the task nor its output can name their type, which nothing declares `'static`.

/// Runs `$body` in a function that is compiled for a unit.
///
/// Each operation on lanes is one such function for all registers. Inlining calls takes most of a kernel's compilation, so
/// that one call for each register would take much longer.
macro_rules! compiled_for {
    ($enabled:literal, ($($argument:ident: $type:ty),*) -> $output:ty $body:block) => {{
        #[target_feature(enable = $enabled)]
        #[inline]
        fn compiled($($argument: $type),*) -> $output $body
        // SAFETY: lanes exist only where the unit does; see the module.
        unsafe { compiled($($argument),*) }
    }};
}

/// Implements the operator `$trait` for all registers of lanes.
macro_rules! operator {
    ($vectors:ident [$($i:tt)+], $enabled:literal, $trait:ident, $method:ident, $f:ident) => {
        impl $trait for $vectors {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let a = self;
                compiled_for!($enabled, (a: $vectors, other: $vectors) -> $vectors {
                    $vectors($($f(a.$i, other.$i)),+)
                })
            }
        }
    };
}

/// Registers of `$each` numbers as lanes.
macro_rules! vectors {
    (
        $vectors:ident [$($i:tt $register:ty),+], $narrow:ident, $enabled:literal, $each:literal,
        $add:ident, $sub:ident, $mul:ident, $div:ident, $fma:ident, $splat:ident, $sqrt:ident, $load:ident, $store:ident
    ) => {
        #[derive(Clone, Copy)]
        struct $vectors($($register),+);

        operator!($vectors [$($i)+], $enabled, Add, add, $add);
        operator!($vectors [$($i)+], $enabled, Sub, sub, $sub);
        operator!($vectors [$($i)+], $enabled, Mul, mul, $mul);
        operator!($vectors [$($i)+], $enabled, Div, div, $div);

        impl Neg for $vectors {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                let x = self;
                compiled_for!($enabled, (x: $vectors) -> $vectors {
                    $vectors($($sub($splat(-0.0), x.$i)),+)
                })
            }
        }

        impl Real for $vectors {
            #[inline(always)]
            fn of(x: f64) -> Self {
                compiled_for!($enabled, (x: f64) -> $vectors { $vectors { $($i: $splat(x)),+ } })
            }

            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                let x = self;
                compiled_for!($enabled, (x: $vectors, a: $vectors, b: $vectors) -> $vectors {
                    $vectors($($fma(x.$i, a.$i, b.$i)),+)
                })
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                let x = self;
                compiled_for!($enabled, (x: $vectors) -> $vectors { $vectors($($sqrt(x.$i)),+) })
            }
        }

        impl Lanes for $vectors {
            type Narrow = $narrow;

            const LANES: usize = {
                let lanes = $each * [$($i),+].len();
                assert!(lanes <= WIDTH);
                lanes
            };

            #[inline(always)]
            fn pack(lanes: [f64; WIDTH]) -> Self {
                let from = lanes.as_ptr();
                // SAFETY: the registers are no longer than the array; see the module for the instructions.
                unsafe { Self($($load(from.add($i * $each))),+) }
            }

            #[inline(always)]
            fn unpack(self) -> [f64; WIDTH] {
                let mut lanes = [0.0; WIDTH];
                let to = lanes.as_mut_ptr();
                // SAFETY: the registers are no longer than the array; see the module for the instructions.
                unsafe { $($store(to.add($i * $each), self.$i));+ }
                lanes
            }

            #[inline(always)]
            fn outlined<K: LanesTask<Self>>(task: K) -> K::Output {
                #[target_feature(enable = $enabled)]
                #[inline(never)]
                fn run<K: LanesTask<$vectors>>(task: K) -> K::Output {
                    task.run()
                }
                // SAFETY: this is called only where the unit exists; see the module.
                unsafe { run(task) }
            }
        }
    };
}

/// A unit: its token, which only `detect` makes, and its narrow and wide vectors of registers with `$each` numbers.
macro_rules! unit {
    (
        $(#[$doc:meta])* $token:ident, $enabled:literal, $detected:ident [$($feature:tt)+],
        $narrow:ident [$($few:tt)+], $wide:ident [$($many:tt)+], $each:literal, $($instruction:ident),+
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $token(());

        impl $token {
            /// Returns the token of the SIMD unit if the processor has all its features, otherwise `None`.
            pub fn detect() -> Option<Self> {
                ($($detected!($feature))&&+).then_some(Self(()))
            }

            /// Runs a computation in lanes of this SIMD unit.
            pub fn run<K: SimdTask>(self, task: K) -> K::Output {
                #[target_feature(enable = $enabled)]
                fn run<K: SimdTask>(task: K) -> K::Output {
                    task.run::<$wide>()
                }
                // SAFETY: `detect` has seen every feature that the function enables.
                unsafe { run(task) }
            }
        }

        vectors!($narrow [$($few)+], $narrow, $enabled, $each, $($instruction),+);
        vectors!($wide [$($many)+], $narrow, $enabled, $each, $($instruction),+);
    };
}
