#!/usr/bin/env bash
# Fuzzes all readers with the core under ASan and UBSan: any report of theirs is a failure. Arguments: those of
# `python -m fuzz` (tests/fuzz/__main__.py). Hostile values in every place of the written files come first.
# The extension is built next to the core's checks, in build/checks-address, and combined with the package's Python
# files. Debian's Python is not instrumented, so the sanitizers' libraries are loaded before it. gcc only.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/checks-address
site="$PWD/build/sanitized"
mkdir -p build
export PATH="$PWD/.venv/bin:$PWD/build/tools/bin:$PATH" PYTHONPATH="$PWD/build/tools"
echo "Building the extension under ASan and UBSan (minutes)"
{ cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DJOINTID_BUILD_CHECKS=ON -DJOINTID_BUILD_EXTENSION=ON \
    -DJOINTID_SANITIZE=address,undefined -DPython_EXECUTABLE="$PWD/.venv/bin/python" \
    -Dpybind11_DIR="$(python -m pybind11 --cmakedir)" &&
  cmake --build "$build" --target _core --parallel "$(getconf _NPROCESSORS_ONLN)"; } >build/sanitized.log 2>&1 ||
  { cat build/sanitized.log; exit 1; }

rm -rf "$site"
mkdir -p "$site/jointid/data"
cp -r python/jointid/. "$site/jointid"
cp examples/data/* "$site/jointid/data"
rm -f "$site"/jointid/_core*.so
cp "$build"/_core*.so "$site/jointid"
# An editable install comes before all paths.
cat >"$site/sitecustomize.py" <<'FIRST'
import sys
sys.meta_path[:] = [each for each in sys.meta_path if not type(each).__module__.startswith("_editable_")]
FIRST

preloaded=""
for library in libasan.so libubsan.so libstdc++.so; do
  preloaded="$preloaded $(readlink -f "$(g++ -print-file-name="$library")")"
done
# Leaks are not reported, because Python keeps its memory. Too large an allocation is an ordinary MemoryError.
# Freed memory is kept back for some cases, not for 256 MB: fresh pages take a tenth to a fifth of the time.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1:strict_string_checks=1:quarantine_size_mb=16
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export PYTHONPATH="$site"
LD_PRELOAD="$preloaded" python - <<'PROOF'
import ctypes, jointid, jointid._core as core
from pathlib import Path
content = Path(core.__file__).read_bytes()
assert b"__asan_init" in content and b"__ubsan_handle" in content, "the extension is not instrumented"
assert hasattr(ctypes.CDLL(None), "__asan_init"), "ASan is not loaded"
print("The core is", core.__file__)
PROOF
if [ "${READ_BACK:-1}" = 1 ]; then
  LD_PRELOAD="$preloaded" JOINTID_READ_BACK=all python -m pytest --numprocesses auto --dist load tests/base/test_read_back.py
fi
PYTHONPATH="$site:$PWD/tests" LD_PRELOAD="$preloaded" exec python -m fuzz "$@"
