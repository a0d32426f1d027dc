//! How many floating-point operations a trajectory takes: the kernels themselves, run with numbers that count.

use crate::numerics::{Lanes, Real, WIDTH};
use crate::rod::Effects;
use crate::shooting::batch::{
    InitialCondition, Method,
    block_key::BlockKey,
    kernel::{along_profile, by_effects},
};
use crate::shooting::{Nystrom8, Resolution, ShootingMap};
use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

/// A number that counts what is done with it: 1 for an addition, multiplication, division or root, 2 for a fused multiply-add.
#[derive(Clone, Copy, Debug)]
struct Counted(f64);

fn counted(operations: u64, x: f64) -> Counted {
    COUNT.set(COUNT.get() + operations);
    Counted(x)
}

macro_rules! operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Counted {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                counted(1, self.0 $op other.0)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Real for Counted {
    fn of(x: f64) -> Self {
        Self(x)
    }

    fn mul_add(self, a: Self, b: Self) -> Self {
        counted(2, self.0 * a.0 + b.0)
    }

    fn sqrt(self) -> Self {
        counted(1, self.0.sqrt())
    }
}

impl Lanes for Counted {
    type Narrow = Self;

    const LANES: usize = 1;

    fn pack(lanes: [f64; WIDTH]) -> Self {
        Self(lanes[0])
    }

    fn unpack(self) -> [f64; WIDTH] {
        [self.0; WIDTH]
    }
}

/// Operations of one trajectory in `steps` steps of [`Nystrom8`], from its contact to its answer. Stages whose results nothing
/// needs are counted too; a compiler leaves them out.
#[must_use]
pub fn flops_of_nystrom8(effects: Effects, steps: u32, condition: &InitialCondition) -> u64 {
    let method = Method::new(Resolution::of(steps)).with_effects(effects);
    let key = BlockKey::new(method, condition, steps);
    COUNT.set(0);
    let conditions = [condition; WIDTH];
    if key.effects.profile {
        let _ = along_profile::<ShootingMap, Counted>(method, &key, &conditions);
    } else {
        let _ = by_effects::<Nystrom8, ShootingMap, Counted>(method, &key, &conditions);
    }
    COUNT.get()
}
