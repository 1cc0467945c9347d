#!/usr/bin/env bash
# Builds and tests everything on a Debian 12 machine: the warnings-as-errors build with every test, then the tests
# again under the address and undefined-behaviour sanitizers.
set -euo pipefail
cd "$(dirname "$0")"

usage() {
  cat <<'TEXT'
Usage: ./test.sh [PART…]
  packages  install the Debian packages that are missing
  dev       build with warnings as errors, run every test
  asan      build with sanitizers (leaks count), run every test again
Without PART: all of them, in this order.
TEXT
}

# run_preset PRESET
run_preset() {
  local preset="$1"
  echo "== $preset: configure and build"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset"
  echo "== $preset: tests"
  ctest --preset "$preset" -j "$(nproc)"
}

run_part() {
  case "$1" in
    packages) .ci/install_packages ;;
    dev) run_preset dev ;;
    asan) run_preset asan ;;
    -h | --help) usage ;;
    *)
      echo "test.sh: there is no part \"$1\"" >&2
      usage >&2
      exit 1
      ;;
  esac
}

if [[ $# -eq 0 ]]; then
  set -- packages dev asan
fi
for part in "$@"; do
  run_part "$part"
done
