#!/usr/bin/env bash
# Builds the Debian package in target/debian: the program with its gateway, manual pages, the service, an example configuration. Needs cargo-deb.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-target}
cargo build --release --locked --features serve
"$target/release/cylwatch" man --out packaging/man
trap 'rm -rf packaging/man' EXIT
gzip --best --no-name --force packaging/man/*.1
cargo deb --no-build --no-strip --features serve "$@"
