// Measured radii, piece by piece, so that no step crosses a row; the twin of `Measured` in `crates/mechanics/src/shooting/material.rs`.

struct Piece {
    // where it begins
    tau: real,
    begin: real,
    // of the radius
    cubic: array<real, 4>,
}

@group(0) @binding(3) var<storage, read> pieces: array<Piece>;

struct Material {
    piece: Piece,
    gradient: real,
}

// rho/S
fn compliance(material: Material, section: Section) -> real {
    let x = section.arclength - material.piece.begin;
    let c = material.piece.cubic;
    let radius = c[0] + x * (c[1] + x * (c[2] + x * c[3]));
    let square = radius * radius;
    return section.rho / (square * square * (1.0 + material.gradient * section.arclength));
}

// From the contact at tau to the base, in as many steps for every piece.
fn travel(rod: Rod, tau: real, start: Start, steps: u32, at_contact: State) -> State {
    var k = arrayLength(&pieces);
    var y = at_contact;
    var here = tau;
    var section = Section(start.radius, 0.0, start.arclength);
    while k > 0u {
        k--;
        let piece = pieces[k];
        if piece.begin < section.arclength {
            let h = (here - piece.tau) / real(steps);
            let system = System(start.force, 2.0 * rod.bend, rod.spiral, Material(piece, rod.gradient));
            y = integrate(system, gains(rod.taper, h), section, h, steps, y);
            here = piece.tau;
            section = Section(1.0 - rod.taper * piece.begin, 0.0, piece.begin);
        }
    }
    return y;
}
