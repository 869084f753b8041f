#!/bin/sh
# What the simulated kernels do, and in which order, must not depend on the compiler: builds op_stream with g++ and
# with clang++ and compares every event. Usage: compare_compilers.sh [BUILD_FOLDER], or, of builds that are there,
# compare_compilers.sh ONE OTHER. Exit code 1: they differ, and the first events that do are printed.
set -eu

build_both() {
    source=$(cd "$(dirname "$0")/../.." && pwd)
    gxx=${GXX:-g++}
    clangxx=${CLANGXX:-$(command -v clang++ || command -v clang++-14)}
    launcher=$(command -v ccache || true)
    one=$1/$(basename "$gxx")
    other=$1/$(basename "$clangxx")
    for compiler in "$gxx" "$clangxx"; do
        folder=$1/$(basename "$compiler")
        cmake -S "$source" -B "$folder" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DRAZOR_BENCHMARKS=OFF \
            -DRAZOR_TARGETS=simulated ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER="$launcher"} ${CMAKE_ARGUMENTS:-} >/dev/null
        cmake --build "$folder" --target op_stream -- ${NINJA_ARGUMENTS:-} >"$folder/log" || {
            cat "$folder/log"
            exit 1
        }
    done
}

if [ $# = 2 ]; then
    one=$1
    other=$2
else
    build_both "${1:-${TMPDIR:-/tmp}/razor-compare-compilers}"
fi
for folder in "$one" "$other"; do
    "$folder/tests/kernels/op_stream" >"$folder/hashes"
done
if cmp -s "$one/hashes" "$other/hashes"; then
    echo "$(basename "$one") and $(basename "$other"): the same events, $(wc -l <"$one/hashes") hashes"
    exit 0
fi
# The scene and the last event at which both agreed.
line=$(cmp "$one/hashes" "$other/hashes" | sed 's/.*line //')
scene=$(head -n "$line" "$one/hashes" | grep -v ' ' | tail -n 1)
before=$(head -n $((line - 1)) "$one/hashes" | tail -n 1 | sed 's/ .*//')
case $before in *[!0-9]* | '') before=0 ;; esac
for folder in "$one" "$other"; do
    "$folder/tests/kernels/op_stream" "$before" $((before + 4097)) |
        awk -v scene="$scene" '!/ /{ in_scene = ($0 == scene) } in_scene' >"$folder/events"
done
echo "$(basename "$one") and $(basename "$other") differ in $scene, after event $before:"
diff -U 30 "$one/events" "$other/events" | head -n "${LINES_SHOWN:-80}"
exit 1
