#!/usr/bin/env bash
# Installs User Mode Linux with its CAN modules for tests/canlab. On Debian-like systems, as root or with sudo.
set -euo pipefail

present() {
  local program
  for program in linux.uml insmod ip; do
    PATH="$PATH:/usr/sbin:/sbin" command -v "$program" >/dev/null || return 1
  done
  compgen -G '/usr/lib/uml/modules/*/kernel/drivers/net/can/vcan.ko' >/dev/null
}

present && exit 0
"$(dirname "$0")/install_packages.sh" tests/canlab user-mode-linux kmod iproute2
present && exit 0
echo "User Mode Linux is installed, but a program or the module vcan is missing" >&2
exit 1
