#!/bin/bash
# check_tree.sh [PROJECT]: what must hold for every file. The top level is exactly as the README says; no file names a
# folder of somebody's machine; no text has tabs or blanks at the ends of its lines.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}"

top_level='.ci .clang-format .clang-tidy .gitignore CMakeLists.txt CMakePresets.json LICENSE README.md analysis configs
isa razor run.sh sim test.sh tests traces'
failures=0

complain() {
    printf '%s\n' "$*"
    failures=$((failures + 1))
}

# Tracked files; of a tree without its repository, all that .gitignore would let in.
if git -c safe.directory='*' rev-parse --show-prefix >/dev/null 2>&1 &&
    [[ -z $(git -c safe.directory='*' rev-parse --show-prefix) ]]; then
    mapfile -d '' files < <(git -c safe.directory='*' ls-files -z)
else
    mapfile -d '' files < <(find . \( -path './build*' -o -path ./out -o -path ./.git -o -name __pycache__ \) -prune \
        -o -type f ! -name '*.tmp' -printf '%P\0')
fi
((${#files[@]} > 0)) || complain "no files found"

expected=$(tr ' ' '\n' <<<"$top_level" | sort)
found=$(printf '%s\n' "${files[@]}" | cut -d / -f 1 | sort -u)
difference=$(diff <(printf '%s\n' "$expected") <(printf '%s\n' "$found") | sed -n 's/^</missing:/p; s/^>/unexpected:/p') || true
if [[ -n $difference ]]; then
    complain "the top level is not as it should be:"$'\n'"$difference"
fi

# forbid WHAT REGEX: no line of a text file matches.
forbid() {
    local lines
    # A tracked file may have been removed from the work tree: grep -s says nothing of it.
    if lines=$(printf '%s\0' "${files[@]}" | xargs -0 grep -s -n -I -P -e "$2" -- /dev/null | head -n 20) && [[ -n $lines ]]; then
        complain "$1:"$'\n'"$lines"
    fi
}

forbid "a folder of one machine" '(^|[^\w.~-])/(work|farm|home|root|Users)/'
forbid "a tab" '\t'
forbid "blanks at the end of a line" '[ \t\r]+$'
for file in run.sh test.sh .ci/run; do
    [[ -x $file ]] || complain "$file: not executable"
done

printf '%s files, %s failures\n' "${#files[@]}" "$failures"
((failures == 0))
