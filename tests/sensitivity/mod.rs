//! Exact derivatives.

mod differences;
mod random_whiskers;

use differences::compare;

#[test]
fn detachments_of_random_whiskers_are_differentiated() {
    let (mut count, mut left_out, mut worst) = (0, 0, 0.0_f64);
    for index in 0..100 {
        let compared = compare(index);
        count += compared.count;
        left_out += compared.left_out;
        worst = worst.max(compared.worst);
    }
    println!("{count} {left_out} {worst:e}");
    assert!(worst < 1e-7, "{worst:e}");
}
