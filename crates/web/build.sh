#!/usr/bin/env bash
# Builds the page of `whiskmap explore`, crates/cli/explore.html. It needs Python and Rust's target for WebAssembly:
#
#     rustup target add wasm32-unknown-unknown
#
# On Debian 12 or later without rustup: apt-get install rustc-web cargo-web rust-web-src lld-19, and RUSTC_BOOTSTRAP=1 with
# CARGO_FLAGS="-Z build-std=std,panic_abort", as in tests/portable/.
set -euo pipefail
cd "$(dirname "$0")/../.."

target=wasm32-unknown-unknown
export RUSTFLAGS="-C target-feature=+simd128"
# shellcheck disable=SC2086
cargo build --locked --profile web --target "$target" -p whiskmap-web ${CARGO_FLAGS:-}
python3 crates/web/assemble.py "${CARGO_TARGET_DIR:-target}/$target/web/whiskmap_web.wasm" "${1:-crates/cli/explore.html}"
