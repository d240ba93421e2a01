#!/usr/bin/env bash
# Builds the core's checks under a sanitizer in build/checks-NAME and runs them. NAME: address or thread.
# Needs the build tools in build/tools; builds no Python extension.
set -euo pipefail
cd "$(dirname "$0")/.."
name="$1"
build="build/checks-$name"
export PATH="$PWD/build/tools/bin:$PATH" PYTHONPATH="$PWD/build/tools"

undefined=undefined
# The checks of alignment, null and object sizes take half of the compiler's time. CI leaves out the checks that
# AddressSanitizer or the processor also makes. By hand everything is checked.
[ "${CI:-}" = true ] && undefined=shift,integer-divide-by-zero,unreachable,vla-bound,return,signed-integer-overflow,bounds,bool,enum
case "$name" in
  address) sanitizers="address,$undefined" ;;
  thread) sanitizers=thread ;;
  *) echo "core_checks.sh: NAME must be address or thread, got '$name'" >&2; exit 2 ;;
esac

# With Eigen's own assertions (no NDEBUG), and without -Werror, because instrumented code causes wrong warnings. One
# compiler per processor, because some of them take 1.5 GB.
{ cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DJOINTID_BUILD_CHECKS=ON -DJOINTID_BUILD_EXTENSION=OFF \
    -DPython_EXECUTABLE="$PWD/.venv/bin/python" "-DJOINTID_SANITIZE=$sanitizers" &&
  cmake --build "$build" --parallel "$(getconf _NPROCESSORS_ONLN)"; } >"$build.log" 2>&1 || { cat "$build.log"; exit 1; }

export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1  # by default UBSan only reports
export TSAN_OPTIONS=halt_on_error=1
run=()
# The thread sanitizer of older compilers stops at its start if addresses are randomised too widely.
if [ "$name" = thread ] && setarch "$(uname -m)" -R true 2>/dev/null; then
  run=(setarch "$(uname -m)" -R)
fi
${run[@]+"${run[@]}"} "$build/core_check"
