//! What a machine without a GPU adapter lacks.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// Library through which programs reach Vulkan drivers.
const LOADER: &str = "libvulkan.so.1";

/// Folders with libraries, besides those of `LD_LIBRARY_PATH` and the folder of the architecture in each.
const LIBRARIES: [&str; 5] = ["/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib"];

/// Folders with the files that name Vulkan drivers.
const MANIFESTS: [&str; 3] =
    ["/etc/vulkan/icd.d", "/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d"];

/// Environment variables that name driver files in place of the folders, the newer one first.
const VARIABLES: [&str; 2] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];

/// Returns the first missing part of Vulkan on Linux, in one line: the loader, a driver, or a device for it. Elsewhere it names the interfaces.
#[must_use]
pub fn missing() -> String {
    if !cfg!(target_os = "linux") {
        return "no driver of Vulkan, Metal or DirectX 12 was found".to_owned();
    }
    if !has_loader() {
        return format!("the Vulkan loader {LOADER} was not found; Debian's package is libvulkan1");
    }
    let named = VARIABLES.iter().find_map(|name| Some((*name, env::var_os(name)?)));
    let (place, files) = match &named {
        Some((name, value)) => {
            let files = env::split_paths(value).filter(|file| file.exists());
            (format!("{name}={}", value.display()), files.collect::<Vec<_>>())
        }
        None => (MANIFESTS.join(", "), manifests()),
    };
    missing_driver(&place, &files)
}

/// The missing part with a loader, where drivers are looked for in `place` and have these `files`.
fn missing_driver(place: &str, files: &[PathBuf]) -> String {
    match files {
        [] => format!(
            "no Vulkan driver is installed: no file in {place}; a container needs that of the GPU (with NVIDIA's toolkit \
             NVIDIA_DRIVER_CAPABILITIES=all), or Mesa's (Debian's package mesa-vulkan-drivers)"
        ),
        files => {
            let files = files.iter().map(|file| file.display().to_string());
            let files: Vec<String> = files.collect();
            format!("no Vulkan driver finds a device: {}", files.join(", "))
        }
    }
}

fn has_loader() -> bool {
    let named = env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    let named: Vec<PathBuf> = env::split_paths(&named).collect();
    let of_system = LIBRARIES.iter().flat_map(|folder| {
        let folder = Path::new(folder);
        let of_architecture = format!("{}-linux-gnu", env::consts::ARCH);
        [folder.to_owned(), folder.join(of_architecture)]
    });
    let mut folders = named.into_iter().chain(of_system);
    folders.any(|folder| folder.join(LOADER).exists())
}

/// The driver files of the system, in order.
fn manifests() -> Vec<PathBuf> {
    let folders = MANIFESTS.iter().filter_map(|folder| fs::read_dir(folder).ok());
    let files = folders.flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .collect();
    files.sort();
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_names_the_first_missing_part() {
        let none = missing_driver("/etc/vulkan/icd.d", &[]);
        assert!(
            none.contains("no file in /etc/vulkan/icd.d") && none.contains("mesa-vulkan-drivers")
        );
        let some =
            missing_driver("/etc/vulkan/icd.d", &[PathBuf::from("/etc/vulkan/icd.d/a.json")]);
        assert_eq!(some, "no Vulkan driver finds a device: /etc/vulkan/icd.d/a.json");
    }
}
