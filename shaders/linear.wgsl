// A radius that is linear in the arclength, and a modulus that is; the way along it. The twin of `Uniform` and `Graded` in
// `crates/mechanics/src/shooting/material.rs`.

struct Material {
    gradient: real,
}

// rho/S
fn compliance(material: Material, section: Section) -> real {
    if GRADIENT {
        return section.inverse_cube / (1.0 + material.gradient * section.arclength);
    }
    return section.inverse_cube;
}

// From the contact at tau to the base.
fn travel(rod: Rod, tau: real, start: Start, steps: u32, at_contact: State) -> State {
    let h = tau / real(steps);
    let rho = start.radius;
    return integrate(
        System(start.force, 2.0 * rod.bend, rod.spiral, Material(rod.gradient)),
        gains(rod.taper, h),
        Section(rho, 1.0 / (rho * rho * rho), start.arclength),
        h,
        steps,
        at_contact,
    );
}
