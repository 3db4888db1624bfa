#!/bin/sh
# usage: setup.sh             what `make check`, `make test` and `make run BOARD=...` need
#        setup.sh PACKAGE ... only these packages of the distribution: what `make run` needs
# Says what it installs, does nothing when all is there. Everything but the apt packages goes below build/.
set -eu
cd "$(dirname "$0")/.."

say() { echo "setup: $*"; }

# ---- packages of the distribution -------------------------------------------------------------------------
PACKAGES="gcc libc6-dev make python3 python3-venv
sdcc sdcc-ucsim clang clang-format valgrind socat pkg-config
qemu-system-x86 qemu-system-arm gcc-arm-none-eabi libnewlib-arm-none-eabi libmodbus-dev mbpoll
tshark libncurses-dev sigrok-cli librsvg2-bin"

# Only where there is no Rust yet; Debian 12's is new enough.
find_cargo() {
    command -v cargo || { [ -x "$HOME/.cargo/bin/cargo" ] && echo "$HOME/.cargo/bin/cargo"; }
}

# The sanitizers' run time goes with the version of clang that the distribution has.
clang_runtime() {
    version=$(apt-cache depends clang 2>/dev/null | sed -n 's/.*Depends: clang-\([0-9]*\)$/\1/p')
    [ -z "$version" ] || echo "libclang-rt-$version-dev"
}

install_packages() { # PACKAGE ...
    missing=
    for package; do
        status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
        [ "$status" = installed ] || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    say "apt-get install$missing"
    sudo=
    [ "$(id -u)" = 0 ] || sudo=sudo
    # shellcheck disable=SC2086 # a list
    DEBIAN_FRONTEND=noninteractive $sudo apt-get install -y -q --no-install-recommends $missing \
        >build/setup-apt.log 2>&1 && return 0
    say "package lists are old: apt-get update"
    $sudo apt-get update -q >>build/setup-apt.log 2>&1 || true
    # shellcheck disable=SC2086
    DEBIAN_FRONTEND=noninteractive $sudo apt-get install -y -q --no-install-recommends $missing \
        >>build/setup-apt.log 2>&1 && return 0
    tail -20 build/setup-apt.log >&2
    say "could not install:$missing" >&2
    exit 1
}

# For a board that is left out where they cannot be had.
install_riscv() {
    command -v riscv64-unknown-elf-gcc >/dev/null && command -v qemu-system-riscv32 >/dev/null && return 0
    (install_packages gcc-riscv64-unknown-elf qemu-system-misc) || say "no RISC-V here: boards/rv32virt is left out"
}

# ---- Python packages, pinned, in build/venv ---------------------------------------------------------------
install_python() {
    [ -x build/venv/bin/python ] || { say "python3 -m venv build/venv"; python3 -m venv build/venv; }
    cmp -s host_tests/requirements.txt build/venv/installed.txt && return 0
    say "pip install $(grep -v '^#' host_tests/requirements.txt | tr '\n' ' ')"
    build/venv/bin/pip install -q --disable-pip-version-check -r host_tests/requirements.txt
    cp host_tests/requirements.txt build/venv/installed.txt
}

# ---- Unity, the C test framework: its sources travel in this Python package --------------------------------
UNITY="pytest-unity==0.1.0 --hash=sha256:cd3ceb4aeb4f7866f935957f91874999d8ae13ff014684464ade0b7071e28298"

install_unity() {
    [ -f build/unity/unity.c ] && return 0
    say "Unity from the source distribution of ${UNITY%% *}"
    rm -rf build/unity.part
    mkdir -p build/unity.part
    echo "$UNITY" >build/unity.part/requirement.txt
    build/venv/bin/pip download -q --disable-pip-version-check --no-deps --no-binary :all: --require-hashes \
        -d build/unity.part -r build/unity.part/requirement.txt
    tar -xzf build/unity.part/pytest_unity-0.1.0.tar.gz -C build/unity.part --strip-components=3 \
        pytest_unity-0.1.0/vendor/unity/src
    rm -rf build/unity
    mkdir -p build/unity
    mv build/unity.part/src/unity.c build/unity.part/src/unity.h build/unity.part/src/unity_internals.h build/unity/
    rm -rf build/unity.part
}

# ---- profirust, a DP master, as a test peer. Where it cannot be built its test is skipped and says why ------
PEER=build/interop_profirust

build_profirust() {
    source=host_tests/interop_profirust
    [ "$PEER/release/interop_profirust" -nt "$source/src/main.rs" ] &&
        [ "$PEER/release/interop_profirust" -nt "$source/Cargo.lock" ] && return 0
    say "cargo build of the profirust peer (profirust 0.6.0)"
    mkdir -p "$PEER"
    rm -f "$PEER/skipped"
    cargo=$(find_cargo) || { echo "no Rust compiler here" >"$PEER/skipped"; return 0; }
    if "$cargo" build --release --locked -q --manifest-path "$source/Cargo.toml" --target-dir "$PEER" \
        >"$PEER/build.log" 2>&1; then
        touch "$PEER/release/interop_profirust"
    else
        tail -5 "$PEER/build.log" >&2
        echo "cargo build failed, see $PEER/build.log" >"$PEER/skipped"
    fi
}

# ---- gsdtool reads our GSD file as another program would. Without it that one test is skipped ----------------
install_gsdtool() {
    [ -x build/cargo/bin/gsdtool ] || [ -f build/cargo/skipped ] && return 0
    cargo=$(find_cargo) || return 0
    say "cargo install gsdtool 0.6.0"
    mkdir -p build/cargo
    nice "$cargo" install gsdtool --version 0.6.0 --locked -q -j1 --root build/cargo >build/cargo/install.log 2>&1 ||
        { tail -5 build/cargo/install.log >&2; touch build/cargo/skipped; }
}

mkdir -p build
if [ $# -gt 0 ]; then
    command -v apt-get >/dev/null 2>&1 && install_packages "$@"
    exit 0
fi
if command -v apt-get >/dev/null 2>&1; then
    find_cargo >/dev/null || PACKAGES="$PACKAGES cargo"
    # shellcheck disable=SC2046,SC2086 # lists
    install_packages $PACKAGES $(clang_runtime)
    install_riscv
else
    say "no apt-get here: please provide by hand: $(echo "$PACKAGES" | tr '\n' ' ')"
fi
install_python
install_unity
build_profirust
install_gsdtool
say "ready"
