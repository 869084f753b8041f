# Sourced: runs one fuzz target.

# fuzz_one PROGRAM SECONDS SEED: findings are left beside its corpus; the log only matters when there are some. A corpus of an
# earlier run is gone on with, if the seed is "next".
fuzz_one() {
    local name folder seed=$3 runs=20000 # so many at most, that no faster machine sees more than slower ones
    name=$(basename "$1")
    folder=build/fuzz/$name
    if [[ $seed == next ]]; then
        seed=0 # of libFuzzer's own choice
        runs=-1
    else
        rm -rf "$folder"
    fi
    mkdir -p "$folder"
    if ! "$1" -seed="$seed" -runs="$runs" -max_total_time="$2" -max_len=16384 -artifact_prefix="$folder/" "$folder" >"$folder.log" 2>&1; then
        tail -n 40 "$folder.log" | cut -c 1-400 >&2
        printf '%s: %s\n' "$name" "$(grep -E 'SUMMARY|what\(\)|a seed is refused' "$folder.log" | cut -c 1-200 | xargs -d '\n')" >>build/fuzz/findings
        return 1
    fi
    printf '%s: %s\n' "$name" "$(tail -n 1 "$folder.log")"
}
