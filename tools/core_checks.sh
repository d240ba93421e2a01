#!/usr/bin/env bash
# Builds the core's checks in build/checks-NAME and runs them. NAME: plain, address or thread.
# Uses cmake, ninja and Eigen's headers from .venv; no Python extension is built. In CI, plain is what was built
# with the wheel (Makefile).
set -euo pipefail
cd "$(dirname "$0")/.."
name="$1"
build="build/checks-$name"
export PATH="$PWD/.venv/bin:$PATH"
[ "$name" = plain ] && [ "${CI:-}" = true ] && exec build/wheel/core_check

# Plain: as shipped, warnings are errors. Under a sanitizer: with Eigen's own assertions (no NDEBUG),
# and no -Werror, because instrumented code makes the compiler warn about what is not there.
options=(-DCMAKE_BUILD_TYPE=Debug)
undefined=undefined
# Alignment, null and object sizes take half of the compiler's time; in CI what AddressSanitizer or the processor
# notices as well is left out. By hand everything is checked.
[ "${CI:-}" = true ] && undefined=shift,integer-divide-by-zero,unreachable,vla-bound,return,signed-integer-overflow,bounds,bool,enum
case "$name" in
  plain) options=(-DCMAKE_BUILD_TYPE=Release -DJOINTID_WARNINGS_AS_ERRORS=ON) ;;
  address) options+=("-DJOINTID_SANITIZE=address,$undefined") ;;
  thread) options+=(-DJOINTID_SANITIZE=thread) ;;
  *) echo "core_checks.sh: NAME must be plain, address or thread, got '$name'" >&2; exit 2 ;;
esac

if command -v ccache >/dev/null; then  # where it is installed; its cache outlives `make clean`
  options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1
else
  options+=(-DJOINTID_PRECOMPILED=ON)
fi

cmake -S . -B "$build" -G Ninja -DJOINTID_BUILD_CHECKS=ON -DJOINTID_BUILD_EXTENSION=OFF \
  -DPython_EXECUTABLE="$PWD/.venv/bin/python" "${options[@]}" >"$build.log" 2>&1 ||
  { cat "$build.log"; exit 1; }
# As many at a time as there are processors: some of them take 1.5 GB under a sanitizer.
cmake --build "$build" --parallel "$(getconf _NPROCESSORS_ONLN)" >"$build.log" 2>&1 || { cat "$build.log"; exit 1; }

export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1  # by default UBSan only remarks
export TSAN_OPTIONS=halt_on_error=1
run=()
# The thread sanitizer of older compilers dies at start when addresses are randomised too widely.
if [ "$name" = thread ] && setarch "$(uname -m)" -R true 2>/dev/null; then
  run=(setarch "$(uname -m)" -R)
fi
${run[@]+"${run[@]}"} "$build/core_check"
