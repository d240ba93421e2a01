#!/usr/bin/env bash
# Compiles every file of the core for Windows and for macOS, by zig's clang. Nothing is linked and nothing runs. It
# shows code that another system's headers or compiler refuse. For use by hand and at releases.
set -euo pipefail
cd "$(dirname "$0")/.."
zig=0.17.1  # as in tools/wheels.sh
here="$PWD/build/cross"
python="$here/tools/bin/python"
eigen="$PWD/build/tools/cmeel.prefix/include/eigen3"
mkdir -p "$here"
if [ "$(cat "$here/tools/made" 2>/dev/null)" != "$zig" ]; then
  "${PYTHON:-.venv/bin/python}" -m venv --clear "$here/tools"
  "$python" -m pip install --quiet --no-input --disable-pip-version-check "ziglang==$zig"
  echo "$zig" >"$here/tools/made"
fi
export ZIG_GLOBAL_CACHE_DIR="$here/cache" ZIG_LOCAL_CACHE_DIR="$here/cache"

files="$(find cpp -name '*.cpp' -not -path 'cpp/bind/*' -not -path 'cpp/tests/*' | sort)"
for target in x86_64-windows-gnu aarch64-macos; do
  echo "$target: $(wc -l <<<"$files") files"
  xargs -n 1 dirname <<<"$files" | sort -u | sed "s|^|$here/$target/|" | xargs mkdir -p
  # Each file separately, so that the first error does not hide the others.
  xargs -P "$(getconf _NPROCESSORS_ONLN)" -I '{}' "$python" -m ziglang c++ -target "$target" -std=c++20 \
    -ffp-contract=off -fno-math-errno -fno-trapping-math -O0 -g0 -fno-sanitize=undefined -Icpp -isystem "$eigen" \
    -c '{}' -o "$here/$target/{}.o" <<<"$files" ||
    { echo "cross.sh: not all files compile for $target" >&2; exit 1; }
done
echo "The core compiles for both."
