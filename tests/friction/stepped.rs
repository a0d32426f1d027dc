//! Independent integration of a push with friction: small steps of the push, each of which first tries a contact that sticks. It shares
//! no code with the library: Runge-Kutta's method in the contact's frame, and Newton's method with difference quotients.

/// Conical whisker with a parabola at rest in front of a pole. Lengths are in whisker lengths.
#[derive(Clone, Copy)]
pub struct SteppedWhisker {
    pub taper: f64,
    /// Coefficient of the parabola times the length.
    pub bend: f64,
    /// Radius of the pole.
    pub pole: f64,
    pub friction: f64,
    /// +1 for CB, -1 for CF.
    pub side: f64,
}

/// Contact with its loads: `tau`, normal force and force ratio, both with the sign of the side.
pub type Loaded = [f64; 3];

/// State of the whisker at a contact. Angles are in radians, forces in `E I_base/L^2`, energies in `E I_base/L`.
#[derive(Clone, Copy, Debug)]
pub struct SteppedState {
    pub loaded: Loaded,
    pub arclength: f64,
    /// Distance and direction of the pole's centre from the base.
    pub pole: [f64; 2],
    /// Arclength minus the distance rolled around the pole; without a constant.
    pub slid: f64,
    /// Moment of the pole on the base.
    pub moment: f64,
    pub energy: f64,
}

/// Steps of Runge-Kutta's method for a trajectory.
const STEPS: u32 = 200;

impl SteppedWhisker {
    /// Slope of the parabola at arclength `s`.
    fn slope(&self, s: f64) -> f64 {
        if self.bend == 0.0 {
            return 0.0;
        }
        let mut t = 2.0 * self.bend * s;
        for _ in 0..50 {
            let root = (1.0 + t * t).sqrt();
            let miss = (t * root + t.asinh()) / (4.0 * self.bend) - s;
            t -= miss * 2.0 * self.bend / root;
        }
        t
    }

    /// State at the contact and the loads `loaded`.
    pub fn state(&self, loaded: Loaded) -> SteppedState {
        let [tau, force, ratio] = loaded;
        let radius = |tau: f64| (-self.taper * tau).exp();
        let arclength = match self.taper {
            0.0 => tau,
            taper => (1.0 - radius(tau)) / taper,
        };
        // By tau: tangent angle, position, slope of the rest shape, energy.
        let rate = |tau: f64, [theta, x, y, t, _]: [f64; 5]| {
            let r = radius(tau);
            let moment = -force * (x - ratio * y);
            let root = (1.0 + t * t).sqrt();
            [
                2.0 * self.bend / root.powi(3) + moment / r.powi(4),
                theta.cos(),
                theta.sin(),
                2.0 * self.bend / root,
                0.5 * moment * moment / r.powi(4),
            ]
            .map(|by_s| r * by_s)
        };
        let plus = |a: [f64; 5], h: f64, b: [f64; 5]| -> [f64; 5] {
            std::array::from_fn(|i| a[i] + h * b[i])
        };
        let h = -tau / f64::from(STEPS);
        let mut now = [0.0, 0.0, 0.0, self.slope(arclength), 0.0];
        for step in 0..STEPS {
            let at = tau + h * f64::from(step);
            let k1 = rate(at, now);
            let k2 = rate(at + 0.5 * h, plus(now, 0.5 * h, k1));
            let k3 = rate(at + 0.5 * h, plus(now, 0.5 * h, k2));
            let k4 = rate(at + h, plus(now, h, k3));
            let mean = std::array::from_fn(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0);
            now = plus(now, h, mean);
        }
        let [theta, x, y, _, energy] = now;
        let (px, py) = (-x, -y - self.side * self.pole);
        let direction = py.atan2(px) - theta;
        SteppedState {
            loaded,
            arclength,
            pole: [px.hypot(py), direction],
            slid: arclength - self.side * self.pole * (theta + direction),
            moment: -force * (x - ratio * y),
            energy: -energy,
        }
    }

    /// State near `start` with the pole at `wanted`, and the slid distance `slid` or the ratio of `start`.
    fn solve(&self, start: Loaded, wanted: [f64; 2], slid: Option<f64>) -> SteppedState {
        let mut at = start;
        let miss = |at: Loaded| {
            let state = self.state(at);
            let third = slid.map_or(at[2] - start[2], |slid| state.slid - slid);
            [state.pole[0] - wanted[0], state.pole[1] - wanted[1], third]
        };
        let derivatives = |at: Loaded| {
            let mut columns = [[0.0; 3]; 3];
            for (i, column) in columns.iter_mut().enumerate() {
                let step = 1e-5 * (1.0 + at[i].abs());
                let [mut more, mut less] = [at, at];
                (more[i], less[i]) = (at[i] + step, at[i] - step);
                let [more, less] = [miss(more), miss(less)];
                *column = std::array::from_fn(|k| (more[k] - less[k]) / (2.0 * step));
            }
            columns
        };
        let det = |[a, b, c]: [[f64; 3]; 3]| {
            a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        let mut columns = derivatives(at);
        // The force ratio changes by much with a small slid distance: the iteration ends when steps no longer help.
        let mut last = f64::INFINITY;
        for _ in 0..30 {
            // Small steps take the derivatives of the steps before.
            if last > 1e-4 && last.is_finite() {
                columns = derivatives(at);
            }
            let here = miss(at);
            let whole = det(columns);
            let step: Loaded = std::array::from_fn(|i| {
                let mut replaced = columns;
                replaced[i] = here;
                det(replaced) / whole
            });
            at = std::array::from_fn(|i| at[i] - step[i]);
            let size = step.iter().map(|step| step.abs()).sum::<f64>();
            if size < 1e-6 && size > 0.3 * last {
                break;
            }
            last = size;
        }
        self.state(at)
    }

    /// Moves the pole to the direction of each push of `pushes` after first touch of the resting whisker at `tau`, in small steps. Pushes
    /// are magnitudes in radians. The contact sticks if the friction that this takes is in the cone of friction, and else slides. Where
    /// sliding ends between two steps, it sticks at the extremum of the slid distance of contacts that slide.
    pub fn course(&self, tau: f64, pushes: &[f64]) -> Vec<SteppedState> {
        let touch = self.state([tau, 0.0, 0.0]);
        let mut before = touch;
        // Pushes and slid distances of the last steps, while the contact slides in one direction and the push does not turn.
        let mut slides: Vec<[f64; 2]> = Vec::new();
        let mut last = 0.0;
        let mut held = touch.slid;
        let at = |push: f64| [touch.pole[0], touch.pole[1] + self.side * push];
        let course = pushes.iter().enumerate().map(|(i, push)| {
            let wanted = at(*push);
            let mut start = before.loaded;
            if start[1] == 0.0 {
                // Any small load, because a contact without one cannot stick.
                start[1] = self.side * (push - last);
            }
            let turns = i > 1 && (pushes[i - 1] - pushes[i - 2]) * (push - pushes[i - 1]) < 0.0;
            if turns {
                slides.clear();
            }
            let mut state = self.solve(start, wanted, Some(held));
            let needed = state.loaded[2];
            if needed.abs() > self.friction {
                start[2] = self.friction.copysign(needed);
                state = self.solve(start, wanted, None);
                held = state.slid;
                slides.push([*push, held]);
            } else if let [.., a, b] = slides[..] {
                start[2] = before.loaded[2];
                let sliding = |push: f64| [push, self.solve(start, at(push), None).slid];
                // The value at an extremum is exact to the square of the error of its place.
                let place = extremum([a, b, sliding(*push)]);
                held = sliding(place)[1];
                state = self.solve(state.loaded, wanted, Some(held));
                slides.clear();
            }
            (before, last) = (state, *push);
            state
        });
        course.collect()
    }
}

/// Place of the extremum of the parabola through three points `[x, y]`.
fn extremum([a, b, c]: [[f64; 2]; 3]) -> f64 {
    let first = (b[1] - a[1]) / (b[0] - a[0]);
    let second = ((c[1] - b[1]) / (c[0] - b[0]) - first) / (c[0] - a[0]);
    // y = a + first (x - a) + second (x - a) (x - b).
    0.5 * (a[0] + b[0] - first / second)
}
