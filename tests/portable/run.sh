#!/usr/bin/env bash
# Machines that this is not developed on: builds for aarch64 and runs the physics under qemu, builds for Windows and runs the
# tests under Wine, checks the types for macOS, and builds the page of `whiskmap explore` with its solver. Run by hand, on
# Debian 12 or later, as it needs compilers with sources:
#
#     apt-get install --no-install-recommends rustc-web cargo-web rust-web-src lld-19 \
#         gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user gcc-mingw-w64-x86-64 wine64
#
# With arguments: only these steps, of `mechanics` (that crate alone), `physics`, `windows`, `macos` and `web`.
set -euo pipefail
cd "$(dirname "$0")/../.."

# Debian's compiler; the standard library is built from its sources, for which the compiler must allow what is unstable.
export PATH="/usr/bin:$PATH" RUSTC_BOOTSTRAP=1
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-target}/portable"
export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=wasm-ld-19
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu"
export CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER=x86_64-w64-mingw32-gcc
export CARGO_TARGET_X86_64_PC_WINDOWS_GNU_RUNNER=/usr/lib/wine/wine64

# Makes a Windows of Wine's in the folder $WINEPREFIX, without a display, and with the library that Wine lacks before version 9.
wine_prefix() {
    mkdir -p "$CARGO_TARGET_DIR"
    export WINEPREFIX="$(cd "$CARGO_TARGET_DIR" && pwd)/wine"
    export WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml="
    unset DISPLAY
    /usr/lib/wine/wine64 wineboot --init
    local library="$WINEPREFIX/drive_c/windows/system32/bcryptprimitives.dll"
    if ! [ -e "$library" ]; then
        x86_64-w64-mingw32-gcc -shared -O2 tests/portable/bcryptprimitives.c -ladvapi32 -o "$library"
    fi
}

for step in ${*:-mechanics physics windows macos web}; do
    echo "== $step"
    case "$step" in
    mechanics)
        cargo test -Z build-std --target aarch64-unknown-linux-gnu -p whiskmap-mechanics
        ;;
    physics)
        cargo test -Z build-std --target aarch64-unknown-linux-gnu -p whiskmap --no-default-features --test portable
        ;;
    windows)
        wine_prefix
        # The mechanics are optimised; the rest compiles in less time without. Wine 8 replaces no file that another process has open, as
        # Windows does from version 10 on: the first four tests need that. It sends no Ctrl-Break to a group of processes.
        # Wine has no GPU without a display, and the pages have commands for one.
        cargo test -Z build-std --target x86_64-pc-windows-gnu --profile checked --no-fail-fast \
            --config profile.checked.package.whiskmap.opt-level=1 --config profile.checked.package.whiskmap-cli.opt-level=1 --lib --test portable --test suite -- \
            --skip a_file_that_is_being_read_is_replaced --skip readers_see_whole_files_only \
            --skip of_two_runs_that_create_a_store_differently_one_succeeds \
            --skip runs_at_once_write_the_same_files --skip windows::an_interrupted_run_cleans_up --skip every_command_of_the_pages_runs
        ;;
    macos)
        cargo check -Z build-std --target aarch64-apple-darwin --workspace
        ;;
    web)
        CARGO_FLAGS="-Z build-std=std,panic_abort" crates/web/build.sh "$CARGO_TARGET_DIR/explore.html"
        ;;
    *)
        echo "$step: must be mechanics, physics, windows, macos or web" >&2
        exit 2
        ;;
    esac
done
