#!/bin/bash
# Installs what is missing, builds, and renders the built-in scene natively and inside the simulated machine, from the
# same source. The two pictures must agree bit for bit. Pictures and the report go to out/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. tests/tools/setup.sh

simulated_size=128x96 # some 20 s on one core
simulated_samples=1
picture_size=1024x768
scene=configs/scenes/default.toml
machine=configs/machines/tiny.toml

if (($# > 0)); then
    printf 'usage: ./run.sh\n  Builds Razor; renders %s natively and on %s.\n' "$scene" "$machine"
    [[ $1 == --help || $1 == -h ]] && exit 0 || exit 2
fi

install_missing "${packages_to_run[@]}"
say "building in build/release (the first time some minutes)"
if [[ ! -e build/release/build.ninja ]]; then
    configure release build/release -DRAZOR_TESTS=OFF
fi
compile build/release razor razor-sim

razor=build/release/razor/program/razor
simulator=build/release/sim/program/razor-sim
mkdir -p out

# SSE4 rounds unfused multiply-adds twice; `plain`, AVX2, AVX-512 and the simulated machine give the same bits.
isa=plain
if grep -q -w -m1 avx2 /proc/cpuinfo; then
    isa=auto
fi

say "native picture, $picture_size: out/default.exr, out/default.png"
"$razor" render "$scene" --size "$picture_size" -o out/default.exr -o out/default.png

say "simulated picture, $simulated_size, $simulated_samples sample(s) a pixel, on $machine: out/simulated.exr, out/simulated.png"
"$simulator" run --machine "$machine" --scene "$scene" --size "$simulated_size" --spp "$simulated_samples" \
    -o out/simulated.exr -o out/simulated.png --json out/report.json | tee out/report.txt

say "the same picture natively: out/native.exr; are both the same, bit for bit?"
"$razor" render "$scene" --size "$simulated_size" --spp "$simulated_samples" --isa "$isa" --quiet -o out/native.exr
"$razor" compare --identical out/native.exr out/simulated.exr
say "done: pictures, report.txt and report.json are in out/"
