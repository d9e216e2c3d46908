#!/usr/bin/env bash
# Builds sdfc.wasm beside this script, with rustup's target for WebAssembly. If that is not available,
# it uses Debian's packages rustc-web, cargo-web and rust-web-src, which build the standard library
# too. With --small the module is as small as it can be, and takes longer to build.
set -euo pipefail
case "${1:-}" in
  "") ;;
  --small)
    export CARGO_PROFILE_RELEASE_OPT_LEVEL=z CARGO_PROFILE_RELEASE_LTO=fat
    export CARGO_PROFILE_RELEASE_CODEGEN_UNITS=1 CARGO_PROFILE_RELEASE_PANIC=abort
    export CARGO_PROFILE_RELEASE_STRIP=symbols
    ;;
  *) echo "usage: build.sh [--small]" >&2; exit 2 ;;
esac
package=$(cd "$(dirname "$0")" && pwd)
cd "$package/../../.."
target=wasm32-unknown-unknown
sysroot=$(rustc --print sysroot)
build=(build --release -p sdfc-web --target "$target")

has_target() { [[ -d "$sysroot/lib/rustlib/$target/lib" ]]; }
if ! has_target && command -v rustup > /dev/null; then
  rustup target add "$target" || true
fi
if has_target; then
  cargo "${build[@]}" --target-dir target/wasm
elif [[ -x /usr/bin/cargo && -x /usr/bin/rustc ]]; then
  linkers=("$sysroot"/lib/rustlib/*/bin/rust-lld)
  RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=${linkers[0]} \
    /usr/bin/cargo "${build[@]}" --target-dir target/wasm -Zbuild-std=std,panic_abort
else
  echo "no standard library for $target: rustup target add $target, or Debian's rustc-web cargo-web rust-web-src" >&2
  exit 1
fi
cp "target/wasm/$target/release/sdfc_web.wasm" "$package/sdfc.wasm"
ls -l "$package/sdfc.wasm"
