#!/bin/bash
# Installs what is missing, builds, and runs the tests; --all: by every compiler, sanitizer, width and checker too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. tests/tools/setup.sh
. tests/tools/steps.sh

usage='usage: ./test.sh [--all]
  Builds build/release with g++ for every kernel target and runs its tests.
  --all   also: code style; the benchmarks start; by clang, under address and undefined-behaviour sanitizers: reports,
          pictures and events of the simulator equal those of g++, fuzzers for some seconds, all but the longest tests;
          shared trees under the thread sanitizer; the picture at widths 8, 16 and 64.'
all=false
for argument in "$@"; do
    case $argument in
    --all) all=true ;;
    -h | --help)
        printf '%s\n' "$usage"
        exit 0
        ;;
    *)
        printf 'test.sh: unknown argument %s\n%s\n' "$argument" "$usage" >&2
        exit 2
        ;;
    esac
done

if $all; then
    install_missing "${packages_for_all[@]}"
    benchmarks=ON
else
    install_missing "${packages_to_test[@]}"
    benchmarks=OFF
fi

step "g++: build" build release -DRAZOR_TESTS=ON -DRAZOR_BENCHMARKS=$benchmarks
require_last_step
step "g++: tests" run_tests release
if $all; then
    step "code style" check_style
    step "benchmarks start" start_benchmarks
    step "clang, address and undefined-behaviour sanitizers: build" build asan-ubsan -DRAZOR_TESTS=ON -DRAZOR_FUZZ=ON \
        "$without_lines"
    step "clang: reports and pictures equal those of g++" compare_compilers
    step "fuzzers, $fuzz_seconds s each" fuzz
    step "address and undefined-behaviour sanitizers: tests" run_sanitized_tests
    step "thread sanitizer: build" build_for_threads
    step "thread sanitizer: shared trees" render_shared_trees
    for width in 8 16 64; do
        step "width $width: the picture" render_width $width
    done
fi
summary
