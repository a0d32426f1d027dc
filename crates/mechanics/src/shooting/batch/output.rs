//! What a batch answers for each trajectory, worked out in lanes.

use crate::numerics::{Lanes, WIDTH};
use crate::shooting::batch::pole::{Centre, spread};
use crate::shooting::contact::Contact;
use crate::shooting::sensitivity::{
    Arrival, Curvatures, Energetic, Order, Slopes, Triple, general, similar,
};
use crate::shooting::{
    Base, FirstVariation, FullState, SecondVariation, ShootingMap, StateDerivative,
};
use glam::DVec2;

/// What a batch computes for each trajectory.
pub trait Kind: 'static {
    /// The answer.
    type Answer: Copy + Default + Send;
}

/// The derivatives carried for it, and the answer from their values at the base.
pub trait Derived<T: Lanes>: Kind {
    /// On any rod.
    type General: Order<T>;
    /// On rods that look the same from each of their points.
    type Similar: Order<T, Known = <Self::General as Order<T>>::Known>;

    /// The answers; `pole` is where its centre lies, seen from the contact.
    fn answers(
        arrival: &Arrival<T>,
        pole: [T; 2],
        known: <Self::General as Order<T>>::Known,
    ) -> [Self::Answer; WIDTH];
}

/// The pole, with the first derivatives of its place.
#[derive(Clone, Copy, Debug)]
pub struct First;

/// The same, the base and the bending energy.
#[derive(Clone, Copy, Debug)]
pub struct FirstAndEnergy;

/// The pole, with the first and second derivatives of its place.
#[derive(Clone, Copy, Debug)]
pub struct Second;

impl Kind for First {
    type Answer = ShootingMap;
}

impl<T: Lanes> Derived<T> for First {
    type General = general::First;
    type Similar = similar::First;

    #[inline(always)]
    fn answers(arrival: &Arrival<T>, pole: [T; 2], slopes: Slopes<T>) -> [ShootingMap; WIDTH] {
        let numbers = Centre::new(arrival, pole).map(&slopes);
        spread(numbers, map)
    }
}

impl Kind for FirstAndEnergy {
    type Answer = FirstVariation;
}

impl<T: Lanes> Derived<T> for FirstAndEnergy {
    type General = Energetic<general::First>;
    type Similar = Energetic<similar::First>;

    #[inline(always)]
    fn answers(
        arrival: &Arrival<T>,
        pole: [T; 2],
        (slopes, energy): (Slopes<T>, T),
    ) -> [FirstVariation; WIDTH] {
        let [a, b, c, d, e, g] = Centre::new(arrival, pole).map(&slopes);
        let [cos, sin, x, y, _] = arrival.rod;
        let Contact {
            radius,
            force,
            tangent: [_, slant],
            ..
        } = arrival.contact;
        // The work done along the change: the moment at the base turns it, and the force moves it.
        let work = |[theta, _, y]: Triple<T>| force * x.mul_add(theta, -y);
        let [theta_tau, x_tau, y_tau] = slopes.by_tau;
        let [theta_load, x_load, y_load] = slopes.by_load;
        let force_tau = T::of(-2.0) * arrival.taper * force;
        let energy_tau = work(slopes.by_tau) - force * radius * slant;
        let numbers = [
            a,
            b,
            c,
            d,
            e,
            g,
            cos,
            sin,
            x,
            y,
            force,
            energy,
            theta_tau,
            x_tau,
            y_tau,
            force_tau,
            energy_tau,
            theta_load,
            x_load,
            y_load,
            radius * radius,
            work(slopes.by_load),
        ];
        spread(numbers, |numbers| {
            let [
                a,
                b,
                c,
                d,
                e,
                g,
                cos,
                sin,
                x,
                y,
                force,
                energy,
                changes @ ..,
            ] = numbers;
            let change = |i: usize| StateDerivative {
                angle: changes[i],
                position: DVec2::new(changes[i + 1], changes[i + 2]),
                force: changes[i + 3],
                energy: changes[i + 4],
            };
            FirstVariation {
                full: FullState {
                    map: map([a, b, c, d, e, g]),
                    base: Base {
                        tangent: DVec2::new(cos, sin),
                        position: DVec2::new(x, y),
                        force,
                    },
                    energy,
                },
                by_tau: change(0),
                by_load: change(5),
            }
        })
    }
}

impl Kind for Second {
    type Answer = SecondVariation;
}

impl<T: Lanes> Derived<T> for Second {
    type General = general::Second;
    type Similar = similar::Second;

    #[inline(always)]
    fn answers(
        arrival: &Arrival<T>,
        pole: [T; 2],
        known: Curvatures<T>,
    ) -> [SecondVariation; WIDTH] {
        let centre = Centre::new(arrival, pole);
        let [a, b, c, d, e, g] = centre.map(&known.slopes);
        let (by_tau, by_load) = (
            centre.moved(known.slopes.by_tau),
            centre.moved(known.slopes.by_load),
        );
        let tau_tau = centre.twice(known.by_tau_tau, by_tau, by_tau);
        let tau_load = centre.twice(known.by_tau_load, by_tau, by_load);
        let load_load = centre.twice(known.by_load_load, by_load, by_load);
        let numbers = [
            a,
            b,
            c,
            d,
            e,
            g,
            tau_tau.re,
            tau_tau.im,
            tau_load.re,
            tau_load.im,
            load_load.re,
            load_load.im,
        ];
        spread(numbers, |numbers| {
            let [a, b, c, d, e, g, second @ ..] = numbers;
            let pair = |i: usize| DVec2::new(second[i], second[i + 1]);
            SecondVariation {
                map: map([a, b, c, d, e, g]),
                by_tau_tau: pair(0),
                by_tau_load: pair(2),
                by_load_load: pair(4),
            }
        })
    }
}

fn map([x, y, ln_d_tau, phi_tau, ln_d_load, phi_load]: [f64; 6]) -> ShootingMap {
    ShootingMap {
        pole: DVec2::new(x, y),
        by_tau: DVec2::new(ln_d_tau, phi_tau),
        by_load: DVec2::new(ln_d_load, phi_load),
    }
}
