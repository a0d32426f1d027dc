#![allow(warnings)]
use std::time::Instant;
use whiskmap::integrate::gpu::{Gpu, Precision, shaders};
use whiskmap::integrate::{Engine, Outcome};
use whiskmap::plan::Plan;
use whiskmap::refine::{self, End, RowOfCells, Shot};
use whiskmap::rod::{Side, Units};
use whiskmap::scene::Scene;
use whiskmap::sheet::Sheet;
use whiskmap::shooting::{Reader, Reading};
fn ch(r: &Reading) -> [f64; 9] {
    [
        r.arc_length_mm,
        r.contact_angle_deg,
        r.force_un,
        r.base_force_un.x,
        r.base_force_un.y,
        r.base_moment_nnm,
        r.push_chord_deg,
        r.contact_distance_mm,
        r.energy_nj,
    ]
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let scene = Scene::read(std::path::Path::new(&args[1])).unwrap();
    let plan = Plan::new(&scene).unwrap();
    let method = plan.method;
    let width = scene.grid.push_angle_deg.len();
    for precision in [Precision::F32, Precision::F64] {
        let text = shaders::cells(precision);
        let head = text
            .split("// Functions of one number")
            .next()
            .unwrap()
            .to_owned();
        let mut head2 = String::new();
        for line in head.lines() {
            let mut l = line.to_owned();
            for a in &args[2..] {
                if let Some((k, v)) = a.split_once('=') {
                    if l.starts_with(&format!("const {k} ")) {
                        l = format!("const {k} = real({v});");
                    }
                }
            }
            head2 += &l;
            head2 += "\n";
        }
        let body: String = ["numbers", "difference", "nystrom8", "cells"]
            .iter()
            .map(|n| std::fs::read_to_string(format!("shaders/{n}.wgsl")).unwrap())
            .collect();
        let mut gpu = match Gpu::with_shader(precision, head2 + &body) {
            Ok(g) => g,
            Err(e) => {
                println!("{e}");
                continue;
            }
        };
        let mut worst = [0.0f64; 9];
        let mut sums: Vec<Vec<f64>> = vec![Vec::new(); 9];
        let mut counts = std::collections::BTreeMap::new();
        let mut residuals = Vec::new();
        let mut ratios: Vec<(f64, f64, f64, usize, f64)> = Vec::new();
        let mut handed = 0;
        let mut all = 0;
        let mut wrong_end = 0;
        let (mut t_ref, mut t_gpu) = (0.0, 0.0);
        let mut shown = 0;
        let mut lens = std::collections::BTreeMap::new();
        for own in scene.whiskers() {
            let mut wscale = [0.0f64; 9];
            let mut errs: Vec<[f64; 9]> = Vec::new();
            for side in Side::BOTH {
                let rod = own.rod(side);
                let units = Units {
                    length_mm: 1.0,
                    force_un: 1.0,
                    moment_nnm: 1.0,
                };
                let distances: Vec<f64> = scene
                    .grid
                    .distance_mm
                    .iter()
                    .map(|d| d / own.whisker.length_mm)
                    .collect();
                let sheet = Sheet::new(method, &rod, side, &distances);
                let mut pushes: Vec<f64> = scene
                    .grid
                    .push_angle_deg
                    .iter()
                    .copied()
                    .filter(|p| Side::of_push(*p) == side)
                    .map(f64::to_radians)
                    .collect();
                pushes.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
                let mags: Vec<f64> = pushes.iter().map(|p| p.abs()).collect();
                let rows: Vec<RowOfCells> = (0..distances.len())
                    .map(|row| RowOfCells {
                        sheet: 0,
                        row,
                        pushes: &mags,
                        first: 0,
                    })
                    .collect();
                let t = Instant::now();
                let refs: Vec<_> = refine::references(method, &[&sheet], &rows);
                t_ref += t.elapsed().as_secs_f64();
                let flat: Vec<_> = refs.iter().flatten().cloned().collect();
                if flat.is_empty() {
                    println!("no references");
                    continue;
                }
                let t = Instant::now();
                let _ = gpu.solve(method, &[rod.clone()], &pushes, &flat).unwrap();
                println!("first {:.3}", t.elapsed().as_secs_f64());
                let t = Instant::now();
                let diffs = gpu.solve(method, &[rod.clone()], &pushes, &flat).unwrap();
                println!(
                    "  {} refs {} cells: {:.3} s",
                    flat.len(),
                    diffs.len(),
                    t.elapsed().as_secs_f64()
                );
                t_gpu += t.elapsed().as_secs_f64();
                let reader = Reader::new(units, &rod);
                let one = ch(&reader.of_one(side.sign()));
                let mut cell = 0;
                for (row, refs) in refs.iter().enumerate() {
                    let touch = sheet.rows[row].touch;
                    let guesses = sheet.guesses(row, mags.iter().copied());
                    all += guesses.iter().flatten().count();
                    let shots: Vec<Option<Shot>> = guesses
                        .iter()
                        .zip(&pushes)
                        .map(|(g, p)| {
                            g.map(|g| Shot {
                                rod: 0,
                                tau: g.tau,
                                load: g.load,
                                pole: sheet.rows[row].pole(*p),
                            })
                        })
                        .collect();
                    let flat: Vec<Shot> = shots.iter().flatten().copied().collect();
                    let starts: Vec<(f64, f64)> = flat.iter().map(|s| (s.tau, s.load)).collect();
                    let refined = refine::refine(method, &[&sheet], &flat, &starts);
                    let mut index = vec![None; shots.len()];
                    let mut n = 0;
                    for (i, s) in shots.iter().enumerate() {
                        if s.is_some() {
                            index[i] = Some(n);
                            n += 1;
                        }
                    }
                    let mut scale = [0.0f64; 9];
                    for r in refs {
                        let c = ch(&reader.read(r.tau, &r.state.full, touch, r.push));
                        for k in 0..9 {
                            scale[k] = scale[k].max(c[k].abs());
                            wscale[k] = wscale[k].max(c[k].abs());
                        }
                    }
                    for (m, r) in refs.iter().enumerate() {
                        let base = ch(&reader.read(r.tau, &r.state.full, touch, r.push));
                        for col in r.cells.clone() {
                            let d = &diffs[cell];
                            cell += 1;
                            *counts.entry(format!("{:?}", d.outcome)).or_insert(0) += 1;
                            {
                                let s = whiskmap::rod::arclength(&rod, r.tau);
                                let len = (d.residual as f64
                                    / 20.0
                                    / (s + sheet.rows[row].pole_distance))
                                    .sqrt();
                                let k = (row * 8 / distances.len(), m);
                                let e = lens.entry((side == Side::Cb, k)).or_insert(0.0f64);
                                *e = e.max(len);
                            }
                            if d.outcome != Outcome::Solved {
                                continue;
                            }
                            residuals.push(d.residual as f64);
                            let Some(i) = index[col as usize] else {
                                wrong_end += 1;
                                continue;
                            };
                            let cpu = &refined[i];
                            if cpu.end != End::Solved {
                                wrong_end += 1;
                                if wrong_end < 5 {
                                    println!(
                                        "end {:?} row {row} col {col} push {}",
                                        cpu.end, pushes[col as usize]
                                    );
                                }
                                continue;
                            }
                            let ours = ch(&reader.read(
                                cpu.state.tau,
                                &cpu.state.full,
                                touch,
                                pushes[col as usize],
                            ));
                            let mut bad = false;
                            let mut ev = [0.0; 9];
                            {
                                let s = whiskmap::rod::arclength(&rod, r.tau) + d.numbers[0] as f64;
                                let tau = rod.tau(s);
                                let rho = rod.radius(tau);
                                let load = (r.state.full.force + d.numbers[2] as f64) / rho / rho;
                                let map: Vec<whiskmap::shooting::ShootingMap> =
                                    whiskmap::shooting::batch::Batch::new(method).shoot(&[
                                        whiskmap::shooting::batch::InitialCondition {
                                            rod: &rod,
                                            tau,
                                            load,
                                        },
                                    ]);
                                let miss = map[0]
                                    .pole
                                    .distance(sheet.rows[row].pole(pushes[col as usize]));
                                let s0 = whiskmap::rod::arclength(&rod, r.tau);
                                let wl = ((tau - r.tau).abs() / s0)
                                    .max((load - r.load).abs() / (r.load.abs() + 1.0 / s0 / s0));
                                ratios.push((
                                    miss / d.residual as f64,
                                    miss / (wl * (s0 + sheet.rows[row].pole_distance)),
                                    miss,
                                    row,
                                    r.tau * rod.taper,
                                ));
                            }
                            for k in 0..9 {
                                let theirs = base[k] + one[k] * d.numbers[k] as f64;
                                let e = (theirs - ours[k]).abs() / scale[k];
                                ev[k] = (theirs - ours[k]).abs();
                                if e > 1e-6 {
                                    bad = true;
                                }
                            }
                            errs.push(ev);
                            if bad && shown < 0 {
                                shown += 1;
                                println!(
                                    "row {row} d {:.4} side {side:?} ref {m} of {} tau {:.4} load {:.3} push {:.6} ref push {:.6} residual {:.1e}",
                                    distances[row],
                                    refs.len(),
                                    r.tau,
                                    r.load,
                                    pushes[col as usize],
                                    r.push,
                                    d.residual
                                );
                                for k in 0..9 {
                                    let theirs = base[k] + one[k] * d.numbers[k] as f64;
                                    print!(" {:.1e}", (theirs - ours[k]) / scale[k]);
                                }
                                println!();
                            }
                        }
                    }
                }
            }
            for e in &errs {
                for k in 0..9 {
                    let e = e[k] / wscale[k];
                    worst[k] = worst[k].max(e);
                    sums[k].push(e);
                }
            }
        }
        println!(
            "{precision}: cells with guess {all}; {counts:?}; wrong end {wrong_end}; references {t_ref:.3} s, gpu {t_gpu:.3} s"
        );
        if precision == Precision::F64 {
            let mut last = (false, 99);
            for ((s, (b, m)), e) in &lens {
                if last != (*s, *b) {
                    print!("\n{s} {b}:");
                    last = (*s, *b);
                }
                print!(" {e:.0e}");
            }
            println!();
        }
        residuals.sort_by(f64::total_cmp);
        if residuals.is_empty() {
            continue;
        }
        for k in 0..3 {
            ratios.sort_by(|a, b| [a.0, a.1, a.2][k].total_cmp(&[b.0, b.1, b.2][k]));
            let n = ratios.len();
            print!(
                "  {}: {:.1e} {:.1e} {:.1e}",
                ["miss/bound", "miss/way", "miss"][k],
                [ratios[n / 2].0, ratios[n / 2].1, ratios[n / 2].2][k],
                [
                    ratios[n * 99 / 100].0,
                    ratios[n * 99 / 100].1,
                    ratios[n * 99 / 100].2
                ][k],
                [ratios[n - 1].0, ratios[n - 1].1, ratios[n - 1].2][k]
            );
            println!(" row {} beta tau {:.3}", ratios[n - 1].3, ratios[n - 1].4);
        }
        println!(
            "  residual median {:.1e} worst {:.1e}",
            residuals[residuals.len() / 2],
            residuals.last().unwrap()
        );
        for k in 0..9 {
            sums[k].sort_by(f64::total_cmp);
            print!(
                "  [{k}] {:.1e} {:.1e} {:.1e}",
                sums[k][sums[k].len() / 2],
                sums[k][sums[k].len() * 99 / 100],
                worst[k]
            );
        }
        println!();
    }
}
