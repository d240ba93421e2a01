#!/usr/bin/env bash
# Builds the core's checks under a sanitizer in build/checks-NAME and runs them. NAME: address or thread.
# Needs what builds, in build/tools; no Python extension is built.
set -euo pipefail
cd "$(dirname "$0")/.."
name="$1"
build="build/checks-$name"
export PATH="$PWD/build/tools/bin:$PATH" PYTHONPATH="$PWD/build/tools"

undefined=undefined
# Alignment, null and object sizes take half of the compiler's time; in CI what AddressSanitizer or the processor
# notices as well is left out. By hand everything is checked.
[ "${CI:-}" = true ] && undefined=shift,integer-divide-by-zero,unreachable,vla-bound,return,signed-integer-overflow,bounds,bool,enum
case "$name" in
  address) sanitizers="address,$undefined" ;;
  thread) sanitizers=thread ;;
  *) echo "core_checks.sh: NAME must be address or thread, got '$name'" >&2; exit 2 ;;
esac

# With Eigen's own assertions (no NDEBUG), and no -Werror: instrumented code makes the compiler warn about what is not
# there. As many at a time as there are processors: some of them take 1.5 GB.
{ cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DJOINTID_BUILD_CHECKS=ON -DJOINTID_BUILD_EXTENSION=OFF \
    -DPython_EXECUTABLE="$PWD/.venv/bin/python" "-DJOINTID_SANITIZE=$sanitizers" &&
  cmake --build "$build" --parallel "$(getconf _NPROCESSORS_ONLN)"; } >"$build.log" 2>&1 || { cat "$build.log"; exit 1; }

export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1  # by default UBSan only remarks
export TSAN_OPTIONS=halt_on_error=1
run=()
# The thread sanitizer of older compilers dies at start when addresses are randomised too widely.
if [ "$name" = thread ] && setarch "$(uname -m)" -R true 2>/dev/null; then
  run=(setarch "$(uname -m)" -R)
fi
${run[@]+"${run[@]}"} "$build/core_check"
