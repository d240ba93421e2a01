#!/usr/bin/env bash
# Installs what tests/canlab needs: User Mode Linux with its CAN modules. On Debian and its like, as root or with sudo.
set -euo pipefail
packages=(user-mode-linux kmod iproute2)

fail() {
  echo "tests/canlab needs ${packages[*]}: $1" >&2
  exit 1
}

present() {
  local program
  for program in linux.uml insmod ip; do
    PATH="$PATH:/usr/sbin:/sbin" command -v "$program" >/dev/null || return 1
  done
  compgen -G '/usr/lib/uml/modules/*/kernel/drivers/net/can/vcan.ko' >/dev/null
}

present && exit 0
command -v apt-get >/dev/null || fail "there is no apt-get to install them with"
as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || fail "only root may install them, and there is no sudo"
  sudo -n true 2>/dev/null || fail "only root may install them, and sudo asks for a password"
  as_root=(sudo -n)
fi
echo "Installing ${packages[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${packages[@]}" >/dev/null
present || fail "they are installed, but a program or the module vcan is missing"
