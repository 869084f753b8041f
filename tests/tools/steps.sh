# Sourced by test.sh after setup.sh: the steps of a test run, and their summary.

razor=razor/program/razor # within a build folder
simulator=sim/program/razor-sim
picture=tests/kernels/picture
# ctest's regular expressions have ten parentheses at most: these have none.
# Run by g++'s build alone: studies and whole runs, of which every part has tests of its own.
only_by_gcc='ValidatesItself|^absent_code|^Sweep\.|^DesignSweep\.|^Whole\.|^sweep_|^calibration_|^sharing_|^analysis_|^embree_'
only_by_gcc+='|^kernels_operand_order|^isa_refused|^isa_lint|^tree$|^api_example'
# Ten times as slow under sanitizers: this share of tests, those that took least in g++'s build, is run again, and what is
# shortened there. (A share, as a slower machine would leave out more by a number of seconds.)
sanitized_share=0.7
shortened='^Properties\.|^Scenes/(Watertight|Fields)\.'
# Findings name functions alone, as lines of sources are a fifth of the compile time: the presets as they stand have them.
without_lines=-DCMAKE_CXX_FLAGS_DEBUG='-O1 -fno-omit-frame-pointer'
scene=configs/scenes/default.toml
machines=(configs/machines/tiny.toml configs/machines/copernicus.toml)
simulated=(--size 48x48 --spp 1) # of the picture that compilers are compared by
fuzz_seconds=10
fuzz_seed=${fuzz_seed:-1}

step_lines=()
failed_steps=0
test_reports=()

rm -f build/*/tests.xml build/fuzz/findings

# step NAME COMMAND...: runs the command, notes how it ended; a failure fails the whole run at its end.
step() {
    local name=$1 begin=$SECONDS status before after
    shift
    say "$name"
    before=$(children_seconds)
    set +e
    (
        set -e
        "$@"
    )
    status=$?
    set -e
    after=$(children_seconds)
    if ((status == 0)); then
        last_step=ok
    else
        last_step=FAILED
        failed_steps=$((failed_steps + 1))
    fi
    step_lines+=("$(printf '%-6s %5d s %5d s of processors  %s' $last_step $((SECONDS - begin)) $((after - before)) "$name")")
}

# Processor time of all finished children, in seconds.
children_seconds() {
    awk '{ print int(($16 + $17) / 100) }' "/proc/$$/stat"
}

require_last_step() {
    if [[ $last_step != ok ]]; then
        summary
    fi
}

summary() {
    local line passed=0 failed=0 skipped=0 tests failures disabled skips
    printf '\n'
    for line in "${step_lines[@]}"; do
        printf '%s\n' "$line"
    done
    printf 'in all %d s, %d s of processors\n' $SECONDS "$(children_seconds)"
    for folder in release asan-ubsan; do
        if [[ -e build/$folder/tests.xml ]]; then
            read -r tests failures disabled skips < <(count_tests "build/$folder/tests.xml")
            passed=$((passed + tests - failures - disabled - skips))
            failed=$((failed + failures))
            skipped=$((skipped + disabled + skips))
        fi
    done
    if ((failed_steps > 0)); then
        what_failed
        printf '%d of %d steps FAILED\n' $failed_steps ${#step_lines[@]}
    else
        printf 'all %d steps ok\n' ${#step_lines[@]}
    fi
    printf 'tests: %d passed, %d failed, %d skipped\n' $passed $failed $skipped
    exit $((failed_steps > 0))
}

# Again at the end, where it is looked for: the tests that failed, and what fuzzers found.
what_failed() {
    local folder
    for folder in release asan-ubsan; do
        if [[ -e build/$folder/tests.xml ]]; then
            sed -n -E 's/.*<testcase name="([^"]*)".* status="fail".*/FAILED test \1/p' "build/$folder/tests.xml"
        fi
    done
    if [[ -e build/fuzz/findings ]]; then
        sed 's/^/FAILED /' build/fuzz/findings
    fi
}

# count_tests FILE: tests, failures, disabled and skipped ones of ctest's JUnit report.
count_tests() {
    local word
    for word in tests failures disabled skipped; do
        sed -n -E "0,/^[[:space:]]*$word=/s/^[[:space:]]*$word=\"([0-9]+)\".*/\1/p" "$1"
    done | xargs
}

build() {
    local preset=$1
    shift
    configure "$preset" "build/$preset" "$@"
    compile "build/$preset"
}

# run_tests PRESET [OPTION OF CTEST...]: on a terminal ctest's own progress, elsewhere no word of tests that passed.
run_tests() {
    local arguments=(--preset "$1" -j "$(nproc)" --no-tests=error --output-junit tests.xml "${@:2}")
    if [[ -t 1 ]]; then
        ctest "${arguments[@]}" --progress
    else
        ctest "${arguments[@]}" | grep --line-buffered -v -E '^ *[0-9]+/[0-9]+ Test +#[0-9]+: .* Passed |^ +Start +[0-9]+: '
    fi
}

# One trial shows an error of memory as well as ten do. Numbers, as ctest's regular expressions do not hold so many names.
run_sanitized_tests() {
    local numbers=$PWD/build/asan-ubsan/numbers.txt
    export RAZOR_WATERTIGHT_RAYS=2000 RAZOR_RANDOM_MACHINES=12
    ctest --preset asan-ubsan -N | sed -n -E 's/^ +Test +#([0-9]+): ([^ ]+).*/\1 \2/p' |
        awk -v others="$(sed 's/[\]/&&/g' <<<"$only_by_gcc")" 'NR == FNR { slow[$1]; next }
            !($2 in slow) && $2 !~ others { list = list "," $1 } END { print "0,0,0" list }' <(slow_tests) - >"$numbers"
    run_tests asan-ubsan -I "$numbers"
}

# Names of those that took longest in g++'s last run; without one, none.
slow_tests() {
    local tests=build/release/tests.xml
    printf '\n'
    [[ ! -e $tests ]] ||
        sed -n -E 's/^[[:space:]]*<testcase name="([^" ]+).* time="([0-9.e+-]+)" status=.*/\2 \1/p' $tests | sort -g |
        awk -v share=$sanitized_share '{ names[NR] = $2 } END { for (i = int(share * NR) + 1; i <= NR; ++i) print names[i] }' |
        grep -v -E "$shortened"
}

# The lint of kernels is among the tests.
check_style() {
    find . \( -path './build*' -o -path ./.git \) -prune -o \( -name '*.h' -o -name '*.cpp' \) -print0 |
        xargs -0 clang-format-14 --dry-run -Werror
}

# A moment of every benchmark; no time is asserted.
start_benchmarks() {
    local program count=0
    printf 'v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n' >build/square.obj
    while IFS= read -r -d '' program; do
        case $(basename "$program") in
        isa_cost_*) "$program" sse4 vocabulary 1 ;;
        trace_rays) "$program" build/square.obj --triangles 1000 --size 64 --repeat 1 ;;
        dram_speed) "$program" 100 ;;
        *) "$program" --help ;;
        esac >build/benchmark.log 2>&1 || fail "$program: $(tail -n 1 build/benchmark.log)"
        count=$((count + 1))
    done < <(find build/release/tests/benchmarks -type f -executable -print0)
    printf '%d programs\n' $count
    ((count > 0))
}

# Clang's are those of its sanitized build, which takes other paths through no frame.
compare_compilers() {
    local compiler machine folder=build/compare
    mkdir -p $folder
    for machine in "${machines[@]}"; do
        for compiler in release asan-ubsan; do
            "build/$compiler/$simulator" run --machine "$machine" --scene $scene "${simulated[@]}" \
                -o $folder/$compiler.exr --json $folder/$compiler.json >$folder/$compiler.txt
        done
        tests/tools/compare_reports.py $folder/release.json $folder/asan-ubsan.json
        "build/release/$razor" compare --identical $folder/release.exr $folder/asan-ubsan.exr
    done
    # Every event of the simulated kernels, in order.
    tests/kernels/compare_compilers.sh build/release build/asan-ubsan
}

# As many at once as there are processors. Always from the same seed: what one commit passes and the next does not is the
# code's doing, not chance's. (By hand: fuzz_seed=next fuzz goes on with other mutations.)
fuzz() {
    rm -f build/fuzz/findings
    find build/asan-ubsan/tests/fuzz -maxdepth 1 -name 'fuzz_*' -type f -executable -print0 | sort -z |
        xargs -0 -n 1 -P "$(nproc)" bash -c 'source tests/tools/fuzz.sh; fuzz_one "$0" '"$fuzz_seconds $fuzz_seed"
}

build_for_threads() {
    configure tsan build/tsan -DRAZOR_TESTS=ON -DRAZOR_TARGETS=avx2 "$without_lines"
    compile build/tsan picture
}

# All workers on one tree, built while they render.
render_shared_trees() {
    local samples
    for samples in 1 2; do # within a memory budget, too
        TSAN_OPTIONS=halt_on_error=1 build/tsan/$picture $scene 96 96 $samples recursive 5 $(((samples - 1) * 3)) \
            build/tsan/picture.exr
        "build/release/$razor" render $scene --size 96x96 --spp $samples --isa avx2 --quiet -o build/release/picture.exr
        "build/release/$razor" compare --identical build/release/picture.exr build/tsan/picture.exr
    done
}

# No bit of a picture depends on the width, where all rays ask for one level. Where they all have the camera's field,
# hardly any does: blocks of two levels that are one surface but for rounding are met by whole packets. Else packets, which
# share what they ask for, are wider or narrower. Less optimised, which changes no bit either, it is compiled in half the
# time; g++ then follows too few ways through a kernel to say what is uninitialised.
render_width() {
    local folder=build/width-$1 lod
    configure release "$folder" -DRAZOR_WIDTH="$1" -DRAZOR_TARGETS=avx2 -DRAZOR_TESTS=ON -DRAZOR_BENCHMARKS=OFF \
        -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG -Wno-maybe-uninitialized"
    compile "$folder" picture
    for lod in fixed camera; do
        "$folder/$picture" $scene 256 192 4 $lod 2 0 "$folder/$lod.exr"
        "build/release/$razor" render $scene --size 256x192 --lod $lod --isa avx2 --quiet -o build/release/$lod.exr
    done
    "build/release/$razor" compare --identical build/release/fixed.exr "$folder/fixed.exr"
    "build/release/$razor" compare build/release/camera.exr "$folder/camera.exr" --json "$folder/camera.json" >"$folder/camera.txt"
    tests/tools/compare_last_bits.py "$folder/camera.json"
}
