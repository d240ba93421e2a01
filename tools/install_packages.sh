#!/usr/bin/env bash
# Installs system packages that some tests need: install_packages.sh WHO_NEEDS_THEM PACKAGE ...
# On Debian-like systems, as root or with sudo.
set -euo pipefail
who="$1"
shift

fail() {
  echo "$who needs $*" >&2
  exit 1
}

command -v apt-get >/dev/null || fail "$*: there is no apt-get to install them with"
as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || fail "$*: only root may install them, and there is no sudo"
  sudo -n true 2>/dev/null || fail "$*: only root may install them, and sudo asks for a password"
  as_root=(sudo -n)
fi
echo "Installing $*"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
