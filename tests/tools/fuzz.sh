# Sourced: runs one fuzz target.

# fuzz_one PROGRAM SECONDS: findings are left beside its corpus; the log only matters when there are some.
fuzz_one() {
    local name folder
    name=$(basename "$1")
    folder=build/fuzz/$name
    mkdir -p "$folder"
    if ! "$1" -max_total_time="$2" -max_len=16384 -artifact_prefix="$folder/" "$folder" >"$folder.log" 2>&1; then
        tail -n 40 "$folder.log" >&2
        return 1
    fi
    printf '%s: %s\n' "$name" "$(tail -n 1 "$folder.log")"
}
