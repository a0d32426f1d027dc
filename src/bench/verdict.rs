//! Verdicts on the faster one of two engines, by whole maps.

use super::whole::WholeMap;
use serde::Serialize;
use std::fmt;

/// Comparison of two engines by their times for whole maps.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// Name of the faster one of the two engines.
    pub faster: String,
    /// Name of the slower one of the two engines.
    pub slower: String,
    /// Adapter of the compared GPU engine, with its driver; `None` for two engines on the CPU.
    pub adapter: Option<String>,
    /// Ratio of the median times of the slower and the faster engine, at least 1.
    pub times: f64,
    /// True if a run of the slower engine was as fast as a run of the faster one.
    pub within_spread: bool,
    /// True if the timing of either engine is noisy.
    pub is_noisy: bool,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { faster, slower, times, .. } = self;
        match (self.within_spread, self.is_noisy) {
            (false, _) => write!(f, "{faster} is {times:.1} times as fast as {slower}"),
            (true, false) => {
                write!(f, "{faster} and {slower} are equally fast, within their spread")
            }
            (true, true) => write!(
                f,
                "too noisy to tell whether {faster} or {slower} is faster;\n\
                 repeat on an idle machine, without --quick, or with a larger grid"
            ),
        }
    }
}

impl Verdict {
    /// Returns the verdicts on whole maps: one for the fastest two engines on the CPU, then one for each GPU engine, which is compared with
    /// the fastest engine on the CPU.
    pub fn all(maps: &[WholeMap]) -> Vec<Self> {
        let (gpus, mut hosts): (Vec<_>, Vec<_>) =
            maps.iter().partition(|map| map.adapter.is_some());
        hosts.sort_by(|a, b| a.seconds.median.total_cmp(&b.seconds.median));
        let Some((fastest, others)) = hosts.split_first() else {
            return Vec::new();
        };
        let others = others.first().into_iter().chain(&gpus);
        others.map(|other| Self::of(fastest, other)).collect()
    }

    fn of(one: &WholeMap, other: &WholeMap) -> Self {
        let (faster, slower) = match one.seconds.median <= other.seconds.median {
            true => (one, other),
            false => (other, one),
        };
        Self {
            faster: faster.engine.clone(),
            slower: slower.engine.clone(),
            adapter: other.adapter.clone(),
            times: slower.seconds.median / faster.seconds.median,
            within_spread: slower.seconds.fastest <= faster.seconds.slowest,
            is_noisy: slower.seconds.is_noisy || faster.seconds.is_noisy,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::StageTimes;
    use super::super::timing::Timing;
    use super::{Verdict, WholeMap};

    fn map(engine: &str, adapter: Option<&str>, seconds: &[f64]) -> WholeMap {
        WholeMap {
            engine: engine.to_owned(),
            adapter: adapter.map(str::to_owned),
            seconds: Timing::of(seconds.iter().copied()),
            stages_ms: StageTimes::new(),
            host_us_per_cell: 0.0,
            host_share: 0.0,
            device_can_take: 0.0,
            fallback: 0,
            packed_bytes_per_cell: 0.0,
        }
    }

    #[test]
    fn each_gpu_is_compared_with_the_fastest_engine_on_the_cpu() {
        let cpu = map("cpu", None, &[1.9, 2.0, 2.1]);
        let spectral = map("spectral", None, &[0.9, 1.0, 1.1]);
        let slow = map("gpu 0", Some("lavapipe"), &[4.0]);
        let near = map("gpu 1", Some("A card"), &[0.5, 0.8, 1.0]);
        let verdicts = |maps: &[&WholeMap]| {
            let maps: Vec<WholeMap> = maps.iter().copied().cloned().collect();
            let all = Verdict::all(&maps)
                .into_iter()
                .map(|one| (one.faster, one.slower, one.adapter, one.within_spread));
            all.collect::<Vec<_>>()
        };
        let wanted = |faster: &str, slower: &str, adapter: Option<&str>, within_spread| {
            let [faster, slower] = [faster, slower].map(str::to_owned);
            (faster, slower, adapter.map(str::to_owned), within_spread)
        };
        let on_cpu = wanted("spectral", "cpu", None, false);
        assert_eq!(verdicts(&[]), []);
        assert_eq!(verdicts(&[&cpu]), []);
        assert_eq!(verdicts(&[&cpu, &spectral]), std::slice::from_ref(&on_cpu));
        assert_eq!(
            verdicts(&[&cpu, &spectral, &slow, &near]),
            [
                on_cpu,
                wanted("spectral", "gpu 0", Some("lavapipe"), false),
                wanted("gpu 1", "spectral", Some("A card"), true),
            ]
        );
        let alone = wanted("cpu", "gpu 0", Some("lavapipe"), false);
        assert_eq!(verdicts(&[&cpu, &slow]), [alone]);
    }

    #[test]
    fn a_verdict_on_noisy_timings_names_no_faster_engine() {
        let text = |cpu: &[f64], gpu: &[f64]| {
            let maps = [map("cpu", None, cpu), map("gpu", Some("A card"), gpu)];
            Verdict::all(&maps)[0].to_string()
        };
        let quiet = text(&[1.95, 2.0, 2.05], &[2.0, 2.1, 2.2]);
        assert_eq!(quiet, "cpu and gpu are equally fast, within their spread");
        for (cpu, gpu) in [([1.0, 2.0, 3.0], [2.0, 2.1, 2.2]), ([1.95, 2.0, 2.05], [2.0, 2.5, 3.0])]
        {
            let noisy = text(&cpu, &gpu);
            assert!(noisy.starts_with("too noisy to tell"), "{noisy}");
            assert!(noisy.contains("an idle machine"), "{noisy}");
        }
        // Noise does not matter where no runs overlap.
        let apart = text(&[1.0, 2.0, 3.0], &[8.0, 9.0, 10.0]);
        assert_eq!(apart, "cpu is 4.5 times as fast as gpu");
    }
}
