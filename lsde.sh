#!/usr/bin/env bash
# Sets up, builds, shows and tests lsde. `./lsde.sh help` lists the commands.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

# What one demo costs: about three minutes on two cores. Set any of them in the environment to change it.
demo_scene=${DEMO_SCENE:-scenes/glass-sphere.glb}
demo_photons=${DEMO_PHOTONS:-2000000}
demo_spp=${DEMO_SPP:-32}
demo_reference_seconds=${DEMO_REFERENCE_SECONDS:-60} # CPU seconds of the path tracer

# Debian 12 packages; README.md says what each is for.
packages=(
    g++ cmake ninja-build pkg-config python3
    libembree-dev libopenexr-dev libtinygltf-dev libdraco-dev libmeshoptimizer-dev libwebp-dev libflann-dev liblz4-dev libglm-dev libtbb-dev
    libcli11-dev libspdlog-dev libfmt-dev nlohmann-json3-dev libxxhash-dev
    libpng-dev doctest-dev libbenchmark-dev
)

usage() {
    cat <<'TEXT'
usage: ./lsde.sh COMMAND
  set-up [PACKAGE...]
          install the packages that the build needs, and those named (Debian 12; elsewhere: name them)
  build   set-up, then build the program: build/release/lsde
  demo    build, then render the caustic of a glass sphere, a path-traced reference of it, and compare them: out/
  test    set-up, then build and run all tests
  help    this text
TEXT
}

is_debian_12() { (. /etc/os-release && [[ $ID == debian && ${VERSION_ID-} == 12 ]]) 2>/dev/null; }

# Prints those of the packages named that are not installed.
missing_packages() {
    comm -23 <(printf '%s\n' "$@" | sort) \
        <(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
            sed -n 's/^installed //p' | sort)
}

# Runs a command as root.
as_root() {
    if ((EUID == 0)); then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        echo "lsde.sh: cannot install packages: not root, and there is no sudo" >&2
        return 1
    fi
}

# Installs those of the packages named that are missing (Debian 12).
install_packages() {
    local missing
    mapfile -t missing < <(missing_packages "$@")
    ((${#missing[@]} == 0)) && return
    echo "lsde.sh: installing ${missing[*]}"
    # Lists that are absent or old make the installation fail; a source that cannot be reached may not matter to it.
    as_root apt-get -q update || echo "lsde.sh: apt-get update failed; going on with the lists there are" >&2
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -q install --yes --no-install-recommends "${missing[@]}"
}

set_up() {
    local tool wanted=("${packages[@]}" "$@")
    if is_debian_12; then
        install_packages "${wanted[@]}"
        return
    fi
    echo "lsde.sh: this is not Debian 12; needed is what these Debian 12 packages hold: ${wanted[*]}" >&2
    for tool in g++ cmake ninja pkg-config python3; do
        command -v "$tool" >/dev/null || { echo "lsde.sh: $tool is missing" >&2 && return 1; }
    done
}

configure() {
    set_up
    cmake --preset release
}

build() {
    configure
    cmake --build --preset release --target lsde
}

demo() {
    build
    local name out program=build/release/lsde
    name=$(basename "$demo_scene" .glb)
    out=out/$name
    mkdir -p out
    "$program" emit "$demo_scene" -o "$out.lsmap" --photons "$demo_photons" --force
    "$program" render "$demo_scene" --map "$out.lsmap" -o "$out.exr" --spp "$demo_spp" --force
    "$program" reference "$demo_scene" -o "$out.reference.exr" --cpu-time "$demo_reference_seconds" --force
    "$program" compare "$out.exr" "$out.reference.exr" --report "$out.html" --force
    printf '\nThe picture: %s.exr and %s.png\nThe reference: %s.reference.exr\nThe comparison, for a browser: %s.html\n' \
        "$out" "$out" "$out" "$out"
}

run_tests() {
    configure
    cmake --build --preset release
    ctest --preset release --parallel "$(nproc)"
}

case ${1-help} in
    set-up) set_up "${@:2}" ;;
    build) build ;;
    demo) demo ;;
    test) run_tests ;;
    help | -h | --help) usage ;;
    *)
        echo "lsde.sh: no command \"$1\"" >&2
        usage >&2
        exit 2
        ;;
esac
