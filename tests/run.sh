#!/usr/bin/env bash
# Everything that must hold: format, lints, documentation, tests. On Debian or Ubuntu it installs Mesa's software
# Vulkan driver (lavapipe) first where no Vulkan driver is found, so that the shaders run on any machine.
set -euo pipefail
cd "$(dirname "$0")/.."

has_driver() {
    [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] ||
        compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null ||
        compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null
}
if [ "$(uname -s)" = Linux ] && ! has_driver; then
    as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi; }
    echo "no Vulkan driver found: installing lavapipe"
    as_root apt-get update -q
    as_root apt-get install -y -q --no-install-recommends mesa-vulkan-drivers
fi
# Mesa complains on standard error where this is unset.
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}"

cargo fmt --check
cargo clippy --all-targets --profile checked --locked -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --locked
WHISKMAP_REQUIRE_GPU=1 cargo test --profile checked --locked --no-fail-fast
