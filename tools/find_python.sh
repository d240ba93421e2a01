#!/usr/bin/env bash
# Prints the Python to make .venv with: $PYTHON when set, otherwise the first one that really runs
# (a name on PATH may be an empty shim), is 3.11 or newer, can make environments and has headers.
set -euo pipefail

usable() {
  "$1" - >/dev/null 2>&1 <<'CHECK'
import ensurepip, pathlib, sys, sysconfig, venv
assert sys.version_info >= (3, 11)
assert pathlib.Path(sysconfig.get_path("include"), "Python.h").exists()
CHECK
}

candidates=("${PYTHON:-}")
[ -n "${PYTHON:-}" ] || candidates=(python3.13 python3.12 python3.11 python3)
for candidate in "${candidates[@]}"; do
  if usable "$candidate"; then
    echo "$candidate"
    exit 0
  fi
done
echo "No usable Python: tried ${candidates[*]}; needed is Python 3.11 or newer with the venv module" \
  "and the C headers (Debian: python3-venv, python3-dev). Name one with PYTHON=/path/to/python3." >&2
exit 2
