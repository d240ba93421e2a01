#!/usr/bin/env bash
# Installs Chromium and its driver for the tests of pages in a browser. On Debian-like systems, as root or with sudo.
set -euo pipefail

present() { command -v chromium >/dev/null && command -v chromedriver >/dev/null; }

present && exit 0
"$(dirname "$0")/install_packages.sh" tests/report/test_in_browser.py chromium chromium-driver
present && exit 0
echo "Chromium is installed, but chromium or chromedriver is not found" >&2
exit 1
