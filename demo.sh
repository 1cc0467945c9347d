#!/usr/bin/env bash
# From a bare Debian 12 to five pictures of a cracked salt crystal and a table of its defects, in ./demo/.
# Installs the packages that are missing, builds, grows the sample, preprocesses it, draws it.
set -euo pipefail
cd "$(dirname "$0")"

now_ms() { echo $(($(date +%s%N) / 1000000)); }

# step WHAT COMMAND…: runs the command and says how long it took.
step() {
  local what="$1" start
  shift
  start="$(now_ms)"
  "$@"
  steps+=("$(printf '%10d ms  %s' "$(($(now_ms) - start))" "$what")")
}

configure() { cmake --preset release -DATOMESH_TESTS=OFF >/dev/null; }
build() { cmake --build --preset release --target atomesh; }

steps=()
sample=nacl-cracked
out=demo
atomesh=build/release/app/atomesh

step "Debian packages" .ci/install_packages
step "configure" configure
step "build" build

mkdir -p "$out"
step "grow the sample: $out/$sample.dat" "$atomesh" sample "$sample" -o "$out/$sample.dat" --truth "$out/$sample-truth.json"
# In salt every tetrahedron's circumsphere has a radius of 2.44 Å; where the crack gapes they are larger: carve there.
step "preprocess it: $out/$sample.crb" "$atomesh" preprocess "$out/$sample.dat" -o "$out/$sample.crb" --carve 2.6

# picture MODE VIEW: each from where its mode shows the crack best.
picture() {
  step "picture: $out/$sample-$1.png" "$atomesh" render "$out/$sample.crb" -o "$out/$sample-$1.png" \
    --mode "$1" --view "$2" --params "samples/$sample.crf" --size 1024x768
}
picture volume-surface -40,25
picture volume -40,25
picture surface -65,28
picture xray left
picture atoms -40,25

defect_table() { "$atomesh" defects "$out/$sample.crb" --csv "$out/$sample-defects.csv" >"$out/$sample-defects.txt"; }
step "defect table: $out/$sample-defects.txt and .csv" defect_table

echo
head -n 12 "$out/$sample-defects.txt"
echo
printf '%s\n' "${steps[@]}"
echo
echo "The pictures and the table are in $PWD/$out. To look at the crystal yourself: $atomesh $out/$sample.crb"
