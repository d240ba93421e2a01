#!/usr/bin/env bash
# Installs jointid into .venv: install.sh [checks | WHEEL [only]]. `only`: compiles nothing if the wheel does not fit.
# Without a wheel it is compiled in build/package, which stays, so that later only changes are compiled. `checks` also
# builds the core's checks. After `make develop` (.venv/.editable) the Python files are used in place.
set -euo pipefail
cd "$(dirname "$0")/.."
compiling="about 3 minutes on 2 cores"  # the first time
python=.venv/bin/python
log=build/install.log
tools="$PWD/build/tools"
quiet_pip() { "$python" -m pip "$1" --quiet --no-input --disable-pip-version-check "${@:2}"; }

# progress: shows, from pip's output of a build, the number of compiled files and the compiler's warnings.
progress() {
  local line shown=0
  while IFS= read -r line; do
    if [[ $line =~ \[([0-9]+)/([0-9]+)\] ]]; then
      local now="${BASH_REMATCH[1]}" all="${BASH_REMATCH[2]}"
      if [ -t 1 ]; then
        printf '\r  %d of %d steps ' "$now" "$all"
      elif ((10 * now / all > shown)); then
        shown=$((10 * now / all))
        echo "  $now of $all steps"
      fi
    elif [[ $line == *" warning: "* ]]; then
      echo "$line"
    fi
  done
  [ ! -t 1 ] || printf '\r\033[K'
}

mkdir -p build
if [[ ${1:-} == *.whl && ! -e $1 ]]; then
  echo "install.sh: there is no wheel $1" >&2
  exit 1
fi
tag="$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')"
if [[ ${1:-} == *.whl && $1 != *-"$tag"-* ]]; then
  echo "$1 is for another Python than .venv's, $tag" >&2
  [ "${2:-}" != only ] || exit 1
  set --
fi
case "${1:-}" in
*.whl)
  echo "Installing $1"
  quiet_pip uninstall --yes jointid 2>/dev/null  # its version does not show that it differs
  rm -f .venv/.editable .venv/.tested .venv/.installed
  quiet_pip install --no-compile "$1"
  ;;
"" | checks)
  if compgen -G 'build/package/_core*.so' >/dev/null; then
    echo "Compiling what is new or changed of jointid"
  else
    echo "Compiling jointid${1:+ and the checks of its core}: $compiling"
  fi
  make --silent --no-print-directory build/tools/.made
  options=(--no-deps --no-build-isolation -Cbuild-dir=build/package)
  [ "${1:-}" != checks ] || options+=(-Ccmake.define.JOINTID_BUILD_CHECKS=ON)
  options+=("-Ccmake.define.JOINTID_WARNINGS_AS_ERRORS=$([ "${CI:-}" = true ] && echo ON || echo OFF)")
  [ ! -e .venv/.editable ] || options+=(--editable)
  # The build tools come before .venv's own packages, and only here: pip would take them for installed.
  PATH="$tools/bin:$PATH" PYTHONPATH="$tools" "$python" -m pip install -v --no-input --disable-pip-version-check \
    --no-compile "${options[@]}" . 2>&1 | tee "$log" | progress ||
    { cat "$log"; echo "jointid could not be built; what the compiler said stands above" >&2; exit 1; }
  echo "Installing what it needs"
  quiet_pip install --no-compile jointid
  ;;
*)
  echo "install.sh: checks or the path of a wheel (.whl) is expected, not $1" >&2
  exit 1
  ;;
esac
# For type checkers, which read the checkout.
"$python" -c 'import shutil, sysconfig; shutil.copy(sysconfig.get_path("platlib") + "/jointid/_core.pyi", "python/jointid")'
