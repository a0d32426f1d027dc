#!/usr/bin/env bash
# Runs all checks: format, lints, documentation, tests, and Python readers of a map and a store. On Debian and Ubuntu, it first
# installs Mesa's software Vulkan driver (lavapipe) if there is no Vulkan driver, so that the shaders run on any machine. It
# installs pip if Python has neither the readers nor pip.
set -euo pipefail
cd "$(dirname "$0")/.."

as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi; }
has_driver() {
    [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] ||
        compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null ||
        compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null
}
if [ "$(uname -s)" = Linux ] && ! has_driver; then
    echo "no Vulkan driver found: installing lavapipe"
    as_root apt-get update -q
    as_root apt-get install -y -q --no-install-recommends mesa-vulkan-drivers
fi
# Mesa prints an error if this is unset.
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}"

# The extension of the Python package has no tests. With it, dependencies have the features that the extension requires, so that its wheel
# is built on the crates that the tests have built.
packages=(-p whiskmap -p whiskmap-cli -p whiskmap-mechanics -p whiskmap-plot -p whiskmap-python)
options=(--all-features --profile checked --locked)

cargo fmt --check
cargo clippy "${packages[@]}" --all-targets "${options[@]}" -- -D warnings
cargo clippy -p whiskmap --lib --no-default-features --profile checked --locked -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --no-deps "${packages[@]}" "${options[@]}"
log="$(mktemp)"
trap 'rm -f "$log"' EXIT
# Some tests wait for processes and files: one thread more than cores keeps all cores busy.
export RUST_TEST_THREADS="${RUST_TEST_THREADS:-$(($(getconf _NPROCESSORS_ONLN) + 1))}"
cargo test "${packages[@]}" "${options[@]}" --no-fail-fast | tee "$log"
if grep -E '^test .* \.\.\. ignored' "$log"; then
    echo "error: tests were ignored, for the reasons above; all tests must run" >&2
    exit 1
fi

# Python reads the files of the program under test as the documentation does.
target="${CARGO_TARGET_DIR:-target}"
export PYTHONPATH="$target/python${PYTHONPATH:+:$PYTHONPATH}"
if ! python3 -c 'import numpy, OpenEXR, xarray, zarr' 2>/dev/null; then
    python3 -m pip --version >/dev/null || as_root apt-get install -y -q --no-install-recommends python3-pip
    python3 -m pip install -q --target "$target/python" numpy OpenEXR xarray zarr
fi
for scene in cone morphology; do
    "$target/checked/whiskmap" map "scenes/$scene.toml" --engine cpu --no-png -o "$target/maps"
    python3 tests/read_map.py "$target/maps/$scene.exr"
done
rounded="$target/maps/rounded"
rm -rf "$rounded" "$target/maps/morphology.zarr"
for format in exr zarr; do
    "$target/checked/whiskmap" map scenes/morphology.toml --engine cpu --no-png --digits 5,force_un=3 --format "$format" -o "$rounded"
done
python3 tests/read_map.py "$rounded/morphology.exr"
python3 tests/read_store.py "$rounded/morphology.zarr"
"$target/checked/whiskmap" map scenes/morphology.toml --engine cpu --format zarr -o "$target/maps"
rm -rf "$target/maps/slice.zarr"
"$target/checked/whiskmap" extract "$target/maps/morphology.zarr" --at taper=0.95 -o "$target/maps/slice.zarr"
python3 tests/read_store.py "$target/maps/morphology.zarr" "$target/maps/slice.zarr"
