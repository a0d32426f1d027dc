//! The program on a driver that fails: `icd.rs` in front of the real one.

use super::cone;
use crate::compute::all_cells;
use crate::shipped;
use assert_cmd::Command;
use std::fs;
use std::process::Output;
use tempfile::TempDir;
use whiskmap::map::{EngineCells, STATE_CHANNELS};
use whiskmap::store::{ChannelValues, StoredMap};

tests! {
    Driver:
        the_map_is_completed_whatever_fails_while_it_runs,
        a_gpu_that_was_asked_for_and_cannot_start_is_an_error;
}

/// The library of a Vulkan driver of this machine, lavapipe's if there is one.
///
/// # Errors
/// There is no driver.
pub fn real_driver() -> Result<String, String> {
    let folders = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
    let files = folders.iter().filter_map(|folder| fs::read_dir(folder).ok());
    let manifests = files.flatten().map(|file| file.unwrap().path());
    let manifest = manifests.min_by_key(|path| !path.to_string_lossy().contains("lvp"));
    let manifest = manifest.ok_or_else(|| format!("no Vulkan driver in {folders:?}"))?;
    let manifest: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(manifest).unwrap()).unwrap();
    Ok(manifest["ICD"]["library_path"].as_str().unwrap().to_owned())
}

/// A folder with the faulty driver and a scene of several submissions in it.
struct Place {
    folder: TempDir,
    real_driver: String,
}

impl Place {
    fn new() -> Self {
        let real_driver = real_driver().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let library = folder.path().join("libfaulty.so");
        Command::new("rustc")
            .args(["--edition", "2024", "--crate-type", "cdylib", "-o"])
            .args([&library, &shipped::root().join("tests/machine/faults/icd.rs")])
            .assert()
            .success();
        let manifest = serde_json::json!({
            "file_format_version": "1.0.0",
            "ICD": { "library_path": library, "api_version": "1.1.0" },
        });
        fs::write(folder.path().join("icd.json"), manifest.to_string()).unwrap();
        let text = cone(2).to_toml().replace("count = 512", "count = 128");
        fs::write(folder.path().join("scene.toml"), text).unwrap();
        Self { folder, real_driver }
    }

    /// Runs `map` with this engine on the driver with this fault.
    fn map(&self, engine: &str, fault: &str) -> Output {
        let manifest = self.folder.path().join("icd.json");
        Command::new(env!("CARGO_BIN_EXE_whiskmap"))
            .args(["map", "scene.toml", "--no-png", "--output", "."])
            .args(["--engine", engine])
            .current_dir(self.folder.path())
            .env("XDG_RUNTIME_DIR", self.folder.path())
            .env("VK_DRIVER_FILES", &manifest)
            .env("VK_ICD_FILENAMES", &manifest)
            .env("REAL_DRIVER", &self.real_driver)
            .env("FAULT", fault)
            .output()
            .unwrap()
    }

    fn stored(&self) -> StoredMap {
        StoredMap::open(&self.folder.path().join("cone.exr")).unwrap()
    }
}

/// The pixels of channels that do not depend on who solved the cells.
fn verdicts(map: &StoredMap) -> [Vec<u32>; 2] {
    ["regime", "status"].map(|name| match map.read_channel(name).unwrap() {
        ChannelValues::U32(codes) => codes,
        ChannelValues::F32(_) => panic!("{name} is u32"),
    })
}

/// The bits of all channels that are NaN or a state.
fn states(map: &StoredMap) -> [Vec<u64>; STATE_CHANNELS.len()] {
    STATE_CHANNELS.map(|name| {
        let samples = map.read_channel(name).unwrap();
        samples.values().map(f64::to_bits).collect()
    })
}

const LOST: i32 = -4;
const OUT_OF_DEVICE_MEMORY: i32 = -2;
const OUT_OF_HOST_MEMORY: i32 = -1;

fn the_map_is_completed_whatever_fails_while_it_runs() {
    let place = Place::new();
    assert!(place.map("cpu", "nothing 0 0").status.success());
    let cpu = place.stored();
    assert_eq!(cpu.counts.engine_cells, EngineCells::default());
    let (wanted, wanted_states) = (verdicts(&cpu), states(&cpu));

    let sound = place.map("gpu", "nothing 0 0");
    assert!(sound.status.success(), "{sound:?}");
    let cells = place.stored().counts.engine_cells;
    assert_eq!(cells.on_cpu_instead, 0);
    let all = all_cells(&cells);
    assert!(all > 8192 && cells.solved > 4096, "{cells:?}");
    assert!(!String::from_utf8_lossy(&sound.stderr).contains("warning"));
    assert!(verdicts(&place.stored()) == wanted);

    for (function, calls, result) in [
        ("vkQueueSubmit", 1, LOST),
        ("vkQueueSubmit", 2, LOST),
        ("vkQueueSubmit", 1, OUT_OF_DEVICE_MEMORY),
        ("vkWaitSemaphores", 0, LOST),
        ("vkWaitSemaphores", 1, LOST),
        ("vkWaitSemaphores", 1, OUT_OF_HOST_MEMORY),
        ("vkGetSemaphoreCounterValue", 3, LOST),
        ("vkBeginCommandBuffer", 1, OUT_OF_HOST_MEMORY),
        ("vkEndCommandBuffer", 1, OUT_OF_HOST_MEMORY),
    ] {
        let fault = format!("{function} {calls} {result}");
        let output = place.map("gpu", &fault);
        let [out, err] = [&output.stdout, &output.stderr].map(|s| String::from_utf8_lossy(s));
        assert!(output.status.success(), "{fault}: {output:?}");
        assert!(!err.contains("panicked"), "{fault}: {err}");
        let warning = err.lines().find(|line| line.starts_with("warning: GPU: device lost"));
        assert!(warning.is_some(), "{fault}: {err}");
        let line = format!("{all:>12}  solved by the CPU in f64 after the engine had failed");
        assert!(out.contains(&line), "{fault}: {out}");

        let map = place.stored();
        let failed = EngineCells { on_cpu_instead: all, ..EngineCells::default() };
        assert_eq!(map.counts.engine_cells, failed, "{fault}");
        assert_eq!(map.attribute("engine").unwrap(), "gpu f32");
        assert!(verdicts(&map) == wanted, "{fault}");
        assert!(states(&map) == wanted_states, "{fault}");
    }
}

fn a_gpu_that_was_asked_for_and_cannot_start_is_an_error() {
    let place = Place::new();
    for fault in ["vkCreateDevice 0 -3", "vkCreateBuffer 0 -2", "vkCreateShaderModule 0 -1"] {
        let output = place.map("gpu", fault);
        let err = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{fault}: {err}");
        assert!(err.starts_with("error: GPU: "), "{fault}: {err}");
        assert!(!place.folder.path().join("cone.exr").exists());
    }
}
