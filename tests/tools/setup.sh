# Sourced by run.sh and test.sh, which first go to the project's folder: packages, builds, messages.

packages_to_run=(g++ cmake ninja-build ccache libosd-dev libglm-dev libopenexr-dev libpng-dev libjpeg-dev libfmt-dev libcli11-dev
                 libtomlplusplus-dev nlohmann-json3-dev libtinygltf-dev libzstd-dev zlib1g-dev liblzma-dev libboost-context-dev libstb-dev)
packages_to_test=("${packages_to_run[@]}" libgtest-dev libgmock-dev python3 binutils)
packages_for_all=("${packages_to_test[@]}" clang-14 lld-14 libclang-rt-14-dev clang-format-14 libbenchmark-dev
                  libembree-dev valgrind python3-matplotlib snakemake slurm-wlm munge)

say() { printf '== %s\n' "$*"; }
fail() {
    printf '%s: %s\n' "$(basename "$0")" "$*" >&2
    exit 1
}

# install_missing PACKAGE...: asks apt only when one of these Debian packages is not there.
install_missing() {
    local missing=() package root=()
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        fail "this is no Debian system; install the like of these packages and build by CMakePresets.json: $*"
    fi
    for package in "$@"; do
        if [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) != installed ]]; then
            missing+=("$package")
        fi
    done
    if ((${#missing[@]} == 0)); then
        return
    fi
    if ((EUID != 0)); then
        command -v sudo >/dev/null || fail "not root and no sudo; as root: apt-get install ${missing[*]}"
        root=(sudo)
    fi
    say "installing Debian packages: ${missing[*]}"
    mkdir -p build
    root+=(env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
    if ! "${root[@]}" update >build/packages.log 2>&1 ||
        ! "${root[@]}" install -y --no-install-recommends "${missing[@]}" >>build/packages.log 2>&1 </dev/null; then
        tail -n 15 build/packages.log >&2
        fail "apt-get could not install: ${missing[*]} (all of its words: build/packages.log)"
    fi
}

# configure PRESET FOLDER [-DNAME=VALUE...]: silent unless it fails. Built as few large sources, which is twice as fast at first.
configure() {
    local preset=$1 folder=$2
    shift 2
    mkdir -p "$folder"
    if ! cmake --preset "$preset" -B "$folder" -DRAZOR_UNITY=ON "$@" >"$folder/configure.log" 2>&1; then
        tail -n 30 "$folder/configure.log" >&2
        fail "cmake could not configure $folder"
    fi
}

# compile FOLDER [TARGET...]: ninja's progress on a terminal, only errors elsewhere.
compile() {
    local folder=$1 quiet=()
    shift
    if [[ ! -t 1 ]]; then
        quiet=(--quiet)
    fi
    # The compiler cache sees paths below this folder as relative ones: another checkout shares it.
    CCACHE_BASEDIR=$PWD ninja -C "$folder" "${quiet[@]}" -j "$(nproc)" "$@"
}
