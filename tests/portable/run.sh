#!/usr/bin/env bash
# Machines that this is not developed on: builds for aarch64 and runs the physics under qemu, and builds the page of
# `whiskmap explore` with its solver. Run by hand, on Debian 12 or later, as it needs compilers with sources:
#
#     apt-get install gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user rustc-web cargo-web rust-web-src lld-19
#
# With arguments: only these steps, of `mechanics` (that crate alone), `physics` and `web`.
set -euo pipefail
cd "$(dirname "$0")/../.."

# Debian's compiler; the standard library is built from its sources, for which the compiler must allow what is unstable.
export PATH="/usr/bin:$PATH" RUSTC_BOOTSTRAP=1
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-target}/portable"
export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=wasm-ld-19
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu"

for step in ${*:-mechanics physics web}; do
    echo "== $step"
    case "$step" in
    mechanics)
        cargo test -Z build-std --target aarch64-unknown-linux-gnu -p whiskmap-mechanics
        ;;
    physics)
        cargo test -Z build-std --target aarch64-unknown-linux-gnu --no-default-features --test portable
        ;;
    web)
        CARGO_FLAGS="-Z build-std=std,panic_abort" crates/web/build.sh "$CARGO_TARGET_DIR/explore.html"
        ;;
    *)
        echo "$step: must be mechanics, physics or web" >&2
        exit 2
        ;;
    esac
done
