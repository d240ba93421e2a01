#!/usr/bin/env bash
# Tests jointid on Debian 13 (Python 3.13, gcc 14, clang 19) in its own folder, by chroot, and on this system with the
# oldest and the newest dependencies that pyproject.toml allows. By hand, as root, on a Debian-like system. Takes almost
# an hour on two cores, and 3 GB in build/matrix. Arguments: the parts to run, by default all.
#   root       debootstrap Debian 13 into build/matrix/trixie, unless it is there
#   compilers  all of cpp/ with gcc 14 and clang 19, warnings are errors, and the core's checks of each
#   trixie     the package built there by gcc 14, the demo, the tests
#   oldest     the tests of the rooms with the oldest dependencies, in this system's Python
#   newest     the same with the newest
#   clang14    like compilers, with this system's clang 14 (Debian 12)
set -euo pipefail
cd "$(dirname "$0")/.."
here="$PWD/build/matrix"
root="$here/trixie"
packages=ca-certificates,python3-venv,python3-dev,g++,clang,make,git
mkdir -p "$here"
[ $# -gt 0 ] || set -- root compilers trixie oldest newest clang14

fail() { echo "matrix.sh: $1" >&2; exit 1; }

# inside COMMAND...: runs it in the root, in a copy of this checkout.
inside() {
  chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/bin:/bin:/usr/sbin:/sbin LANG=C.UTF-8 \
    OPENBLAS_NUM_THREADS=1 bash -o pipefail -c "cd /jointid && $*"
}

# enter: mounts the system files that programs expect, until this script ends.
enter() {
  [ -e "$root/.made" ] || fail "there is no root yet: run the part root"
  mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
  mountpoint -q "$root/dev" || mount --bind /dev "$root/dev"
  local each  # mounts inside /dev are not included: shared memory, terminals
  for each in shm pts; do mountpoint -q "$root/dev/$each" || mount --bind "/dev/$each" "$root/dev/$each"; done
  trap 'umount -l "$root/dev/shm" "$root/dev/pts" "$root/dev" "$root/proc" 2>/dev/null || true' EXIT
}

part_root() {
  [ "$(id -u)" = 0 ] || fail "only root may make and enter a root"
  command -v debootstrap >/dev/null || fail "debootstrap is not installed: apt-get install debootstrap"
  [ -e "$root/.made" ] || { rm -rf "$root"; debootstrap --variant=minbase --include="$packages" trixie "$root" >"$here/root.log" && touch "$root/.made"; }
  # The root has the network and the certificates of this machine.
  cp -L /etc/resolv.conf "$root/etc/"
  cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
  enter
  if [ -n "${PIP_CONFIGURATION:-}" ]; then cp "$PIP_CONFIGURATION" "$root/etc/pip.conf"; fi
  rm -rf "$root/jointid"
  mkdir "$root/jointid"
  git ls-files --cached --others --exclude-standard -z | tar --create --null --files-from - | tar --extract --directory "$root/jointid"
  inside 'test -x /venv/bin/python || python3 -m venv /venv'
  inside "/venv/bin/python -m pip install --quiet --no-input --upgrade 'pip>=25.1'"
  inside '/venv/bin/python -m pip install --quiet --no-input --group build'
}

# strictly COMPILER BIN FOLDER: the command that compiles all of cpp/ into a wheel and the core's checks, and runs them.
# One folder per compiler, because CMake keeps the first one that it finds.
strictly() {
  echo "PATH=$2:\$PATH CXX=$1 python -m pip wheel --quiet --no-input --no-deps --no-build-isolation -Cbuild-dir=$3/$1 \
    -Ccmake.define.JOINTID_BUILD_CHECKS=ON -Ccmake.define.JOINTID_WARNINGS_AS_ERRORS=ON \
    -Ccmake.define.CMAKE_CXX_SCAN_FOR_MODULES=OFF --wheel-dir $3/wheels-$1 . && $3/$1/core_check | tail -1 && ls $3/wheels-$1"
}

part_compilers() {
  enter
  local compiler
  for compiler in g++ clang++; do
    echo "All of cpp/ with $(inside "$compiler --version" | head -1), warnings are errors"
    inside "$(strictly "$compiler" /venv/bin build)"
  done
}

part_clang14() {
  command -v clang++-14 >/dev/null || fail "clang 14 is not installed: apt-get install clang-14, on Debian 12"
  echo "All of cpp/ with $(clang++-14 --version | head -1), warnings are errors"
  "$(tools/find_python.sh)" -m venv "$here/build"
  "$here/build/bin/python" -m pip install --quiet --no-input --upgrade 'pip>=25.1'
  "$here/build/bin/python" -m pip install --quiet --no-input --group build
  bash -o pipefail -c "$(strictly clang++-14 "$here/build/bin" "$here")"
}

part_trixie() {
  enter
  inside '/venv/bin/python -m pip install --quiet --no-input --group test'
  inside '/venv/bin/python -m pip uninstall --quiet --yes jointid; /venv/bin/python -m pip install --quiet build/wheels-g++/*.whl'
  inside 'export PATH=/venv/bin:$PATH && python --version && jointid demo --output /tmp/demo'
  inside '/venv/bin/python -m pytest -q --numprocesses auto --dist loadfile'
}

# bound NAME: on this system, in its own environment. Without pinocchio, because its oldest version needs a newer NumPy
# than jointid, and without the tools of the other tests, which have other limits: tests that need them are skipped.
bound() {
  local environment="$here/$1" python
  python="$environment/bin/python"
  rm -rf "$environment"
  "$(tools/find_python.sh)" -m venv "$environment"
  "$python" -m pip install --quiet --no-input 'pip>=25.1'
  "$python" tools/constraints.py --bound "$1" >"$here/$1.txt"
  "$python" -m pip install --quiet --no-input --constraint "$here/$1.txt" ".[pandas,parquet,ros,hdf5,matlab]" \
    'pytest>=8.3,<10' 'pytest-xdist>=3.8,<4' 'hypothesis>=6.100,<7' pyyaml canopen
  "$python" -m pip list --format freeze | grep -iE '^(numpy|scipy|matplotlib|pandas|pyarrow|h5py|pin|python-can|tomlkit|mcap|rosbags)=='
  "$python" -m pytest -q --numprocesses auto --dist loadfile --ignore tests/exports --ignore tests/repository
}
part_oldest() { bound oldest; }
part_newest() { bound newest; }

for part in "$@"; do
  declare -F "part_$part" >/dev/null || fail "no part $part: root, compilers, trixie, oldest, newest"
  echo "== $part"
  "part_$part"
done
